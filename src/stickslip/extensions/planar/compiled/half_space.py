"""The memory of a half-space, advanced in machine code that JAX calls on its own arrays: many steps at once for each exponential.

Each exponential M of a wavenumber obeys M -> d M + g U at each step, with U the amplitude of slip (`memory.recurrence`), and only
the sum of the real parts of all M is asked for. A step is little work, but M, d and g come from far: they are larger than the cache
of a processor. So M stays as it was when a block of `BLOCK` steps began, and what is asked for after j steps is

    Re sum of d^j M  +  sum over i from 1 to j of K[j - i] U[i],    K[n] = Re sum of d^n g.

At the end of a block M takes all its steps, and tells Re sum of d^j M for the steps of the next one. Both are recurrences of real
numbers, because d and its conjugate are the roots of x^2 - 2 Re(d) x + |d|^2. With w[i] = U[i] + 2 Re(d) w[i-1] - |d|^2 w[i-2] the
sum of d^(n-i) U[i] is w[n] - conj(d) w[n-1], and y[j] = Re(d^j M) is 2 Re(d) y[j-1] - |d|^2 y[j-2].

Wavenumbers lie side by side in lanes, and as many as there are lanes make a chunk. XLA says how arguments come (c_api.h, which
jaxlib brings along).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from stickslip.foundation.kernels.kernels import entry, inlined
from stickslip.foundation.kernels.memory.addresses import integers
from stickslip.foundation.kernels.memory.pointers import rows_of
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH, fused

BLOCK, DOUBLINGS = 8, 3
"""Number of steps in a block, and how often 1 is doubled to get it."""
ROW = 8 * SIMD_WIDTH
"""Size of a row of lanes, bytes."""
XLA_ASKS, XLA_GIVES, XLA_TAKES = 1, 9, 14
"""Places in XLA's call frame, in units of 8 bytes: what it asks beside a call, the arguments, and the results."""
METADATA, METADATA_AT, VERSION_AT = 1, 3, 3
"""The question of XLA which version of its interface a function was written for; where the answer goes, and the version in it."""
VERSION = 1 << 32
"""Version 0.1 of XLA's interface: the minor number stands in the upper half."""
NUMBERS_AT, SIZES_AT = 3, 5
"""Places in XLA's description of an array: the addresses of its numbers and of its sizes."""


class Chunk(NamedTuple):
    """The addresses of the rows of a chunk, and how many rows there are."""

    exponentials: int
    """Real and imaginary part of M for the real part of slip, the same for the imaginary part; four rows for each exponential."""
    ahead: int
    """What M tells for the steps of a block, two rows for each: for the real and the imaginary part of slip."""
    recent: int
    """Slip at the steps since the block began, two rows for each."""
    decay: int
    """Real and imaginary part of d, for each exponential."""
    gain: int
    """Real and imaginary part of g, for each exponential."""
    near: int
    """K, one row for each step of a block."""
    poles: int
    """Number of exponentials."""


@inlined
def numbers(arrays: int, n: int) -> Any:
    """Return the address of the numbers of an array in a list of XLA."""
    return integers(integers(arrays)[n])[NUMBERS_AT]


@entry
def advance(frame: int) -> int:
    """Take a step, called by XLA with the address of a call frame; return 0, XLA's word for success.

    The arguments are those of `Chunk` but the last, as arrays (chunks, rows, lanes), the number of steps since the block began, and
    slip (2, chunks, lanes). The results are the first three and that number, in the place of the arguments, and what M tells now
    (2, chunks, lanes).
    """
    asked = integers(frame)[XLA_ASKS]
    if asked != 0 and integers(asked)[1] % (1 << 32) == METADATA:
        integers(integers(asked)[METADATA_AT])[VERSION_AT] = VERSION
        return 0
    given, taken = integers(frame)[XLA_GIVES], integers(frame)[XLA_TAKES]
    sizes = integers(integers(integers(given)[0])[SIZES_AT])
    chunks, poles, since = sizes[0], sizes[1] // 4, integers(numbers(taken, 3))
    slip, told, step = rows_of(numbers(given, 7)), rows_of(numbers(taken, 4)), since[0]
    for n in range(chunks):
        chunk = Chunk(
            numbers(taken, 0) + n * 4 * poles * ROW,
            numbers(taken, 1) + n * 2 * BLOCK * ROW,
            numbers(taken, 2) + n * 2 * BLOCK * ROW,
            numbers(given, 3) + n * 2 * poles * ROW,
            numbers(given, 4) + n * 2 * poles * ROW,
            numbers(given, 5) + n * BLOCK * ROW,
            poles,
        )
        recent, ahead = rows_of(chunk.recent), rows_of(chunk.ahead)
        recent[2 * step], recent[2 * step + 1] = slip[n], slip[chunks + n]
        if step + 1 < BLOCK:
            told[n], told[chunks + n] = within(chunk, step, 0), within(chunk, step, 1)
        else:
            renew(chunk)
            told[n], told[chunks + n] = ahead[0], ahead[1]
    since[0] = (step + 1) % BLOCK
    return 0


@inlined
def within(chunk: Chunk, step: int, part: int) -> Any:
    """Return what M and the slip since the block began tell after one more step, for the real (0) or imaginary part (1) of slip."""
    near, recent, ahead = rows_of(chunk.near), rows_of(chunk.recent), rows_of(chunk.ahead)
    total = ahead[2 * (step + 1) + part]
    for i in range(step + 1):
        total = fused(near[step - i], recent[2 * i + part], total)
    return total


@inlined
def renew(chunk: Chunk) -> None:
    """Let all exponentials take the steps of a block, and tell what they give in the next one."""
    ahead, recent = rows_of(chunk.ahead), rows_of(chunk.recent)
    decay, gain, kept = rows_of(chunk.decay), rows_of(chunk.gain), rows_of(chunk.exponentials)
    none = 0.0 * decay[0]
    for i in range(2 * BLOCK):
        ahead[i] = none
    for p in range(chunk.poles):
        real, imaginary = decay[2 * p], decay[2 * p + 1]
        twice, square = real + real, fused(real, real, imaginary * imaginary)
        a = b = a_before = b_before = none  # w of the real, and of the imaginary part of slip
        for i in range(BLOCK):
            a_next = fused(twice, a, fused(-square, a_before, recent[2 * i]))
            b_next = fused(twice, b, fused(-square, b_before, recent[2 * i + 1]))
            a_before, a, b_before, b = a, a_next, b, b_next
        x, y = real, imaginary  # of d to the power of BLOCK
        for _ in range(DOUBLINGS):
            x, y = fused(x, x, -(y * y)), (x + x) * y
        g, h = gain[2 * p], gain[2 * p + 1]
        a, a_before = fused(-real, a_before, a), imaginary * a_before  # of the sum of d^(n-i) U[i]
        b, b_before = fused(-real, b_before, b), imaginary * b_before
        a_real = fused(x, kept[4 * p], fused(-y, kept[4 * p + 1], fused(g, a, -(h * a_before))))
        a_imaginary = fused(x, kept[4 * p + 1], fused(y, kept[4 * p], fused(g, a_before, h * a)))
        b_real = fused(x, kept[4 * p + 2], fused(-y, kept[4 * p + 3], fused(g, b, -(h * b_before))))
        b_imaginary = fused(x, kept[4 * p + 3], fused(y, kept[4 * p + 2], fused(g, b_before, h * b)))
        kept[4 * p], kept[4 * p + 1], kept[4 * p + 2], kept[4 * p + 3] = a_real, a_imaginary, b_real, b_imaginary
        a_before, a = a_real, fused(real, a_real, -(imaginary * a_imaginary))  # y
        b_before, b = b_real, fused(real, b_real, -(imaginary * b_imaginary))
        for j in range(BLOCK):
            ahead[2 * j], ahead[2 * j + 1] = ahead[2 * j] + a_before, ahead[2 * j + 1] + b_before
            a_next, b_next = fused(twice, a, -(square * a_before)), fused(twice, b, -(square * b_before))
            a_before, a, b_before, b = a, a_next, b, b_next
