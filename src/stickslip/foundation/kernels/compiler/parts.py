"""Let numba write the code of one function after the other, for a module that is optimised once.

By default numba makes machine code of every function, and optimises each one together with all functions that it calls, again at
every level of calls. Here a function becomes typed code and nothing more; only the whole that an entry needs is linked, optimised
and turned into machine code. It builds on classes of numba that are not public: where one of them is missing, each function is
compiled as numba does by default (`WHY_PLAIN`), which takes longer.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Any, ClassVar

import llvmlite.binding as llvm
from numba import cfunc, njit, types
from numba.extending import models, register_model, typeof_impl

from stickslip.foundation.kernels.kernels import Kernel

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "_nrt": False}
"""Options of kernels: divisions by zero give infinity or NaN as in numpy; a product and a sum may be fused where none is exact."""
WHY_PLAIN = ""
"""Why every function is compiled by itself; empty if it is not."""

try:
    if os.environ.get("STICKSLIP_PLAIN_NUMBA", "") not in ("", "0"):
        raise ImportError("STICKSLIP_PLAIN_NUMBA is set")
    from numba.core.codegen import JITCodeLibrary
    from numba.core.compiler import CompilerBase
    from numba.core.typed_passes import IRLegalization, NativeLowering, NoPythonBackend, NopythonTypeInference
    from numba.core.untyped_passes import FixupArgs, GenericRewrites, IRProcessing, TranslateByteCode

    for _name in ("finalize", "_get_module_for_linking", "_raise_if_finalized", "_ensure_finalized"):
        getattr(JITCodeLibrary, _name)
except (ImportError, AttributeError) as error:
    WHY_PLAIN = str(error)

if not WHY_PLAIN:

    class Passes:
        """The order of passes that our code needs, as numba's compiler asks for it.

        Our code has no closures, array expressions, `with` statements or exceptions, and no branch that is never taken. The pass
        that gives a variable a name of its own for each assignment is left to LLVM, which does the same faster. Without it all
        values of a variable have one type. A whole number may become a float, but what begins as a constant of its module, such as
        `found = NOTHING`, stays that constant: numba refuses to compile another value.
        """

        pipeline_name = "lean"
        exec_times: ClassVar[dict[str, Any]] = {}
        passes = (
            *(TranslateByteCode(), FixupArgs(), IRProcessing(), GenericRewrites()),
            *(NopythonTypeInference(), IRLegalization(), NativeLowering(), NoPythonBackend()),
        )

        def run(self, state: Any) -> None:
            """Compile what is in `state`."""
            for one in self.passes:
                one.run_pass(state)

    class FunctionCode(JITCodeLibrary):  # type: ignore[misc] # numba is untyped
        """The code of one function. It is not linked, not optimised and not turned into machine code."""

        def finalize(self) -> None:
            """Close the library without linking anything.

            The linkage is weak: a linker may drop a function of linkage "linkonce" that nobody has asked for yet, and a part that
            is linked later may ask for it.
            """
            self._raise_if_finalized()
            set_linkage(self._final_module, {llvm.Linkage.external, llvm.Linkage.linkonce_odr}, llvm.Linkage.weak_odr)
            self._finalized = True

        @property
        def codegen(self) -> Any:
            """The code generator, wrapped because a function without machine code has no environment either."""
            return _WithoutEnvironments(self._codegen)

        def enable_object_caching(self) -> None:
            """Do nothing, because there is no machine code to keep."""

        def get_pointer_to_function(self, name: str) -> int:
            """Return 0, because there is no machine code to point to."""
            self._ensure_finalized()
            return 0

        def own_module(self) -> Any:
            """Return the code of this function alone; copies of it are linked into several modules."""
            return super()._get_module_for_linking()

        def _get_module_for_linking(self) -> Any:
            """Return the code of this function and of all functions that it calls."""
            module, below = self.own_module().clone(), list(parts_below(self._linking_libraries))
            for part in below:
                module.link_in(part.own_module(), preserve=True)
            for library in others_of([self, *below]):
                module.link_in(library._get_module_for_linking(), preserve=True)
            set_linkage(module, {llvm.Linkage.weak_odr}, llvm.Linkage.linkonce_odr)
            return module

        def get_llvm_str(self) -> str:
            """Return the text of that code."""
            return str(self._get_module_for_linking())

    class _WithoutEnvironments:
        """A code generator that does not look for a function's environment in machine code."""

        def __init__(self, codegen: Any) -> None:
            self._codegen = codegen

        def set_env(self, name: str, environment: Any) -> None:
            """Do nothing, because only functions that are called from Python have an environment."""

        def __getattr__(self, name: str) -> Any:
            return getattr(self._codegen, name)

    class PartCompiler(CompilerBase):  # type: ignore[misc] # numba is untyped
        """Numba's compiler without what our code does not need, which writes the code of one function."""

        def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
            super().__init__(typingctx, targetctx, library or FunctionCode(targetctx.codegen(), "part"), *rest)

        def define_pipelines(self) -> list[Any]:
            """Return the order of passes."""
            return [Passes()]

    def parts_below(libraries: list[Any]) -> Iterator[FunctionCode]:
        """Yield the parts among the given libraries and all parts that they call, directly or indirectly, each once."""
        seen: set[int] = set()
        waiting = list(libraries)
        while waiting:
            library = waiting.pop()
            if isinstance(library, FunctionCode) and id(library) not in seen:
                seen.add(id(library))
                yield library
                waiting += library._linking_libraries

    def others_of(libraries: list[Any]) -> list[Any]:
        """Return the libraries that the given ones link and that are not parts (numba's own functions), each once."""
        needed = [one for library in libraries for one in vars(library)["_linking_libraries"] if not isinstance(one, FunctionCode)]
        return list({id(one): one for one in needed}.values())

    OPTIONS["pipeline_class"] = PartCompiler


def set_linkage(module: Any, before: set[Any], after: Any) -> None:
    """Change the linkage of the functions that a module defines."""
    for function in module.functions:
        if not function.is_declaration and function.linkage in before:
            function.linkage = after


# ---- kernels as numba sees them --------------------------------------------------------------------------------------------


class _Part(types.Dispatcher):  # type: ignore[misc]
    """The type of a kernel, which is compiled once for whole numbers and not for each number that is written in a call."""

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        return super().get_call_type(context, tuple(map(types.unliteral, args)), kws)


register_model(_Part)(models.OpaqueModel)
_parts: dict[Kernel, Any] = {}
"""Kernels as numba's functions."""


@typeof_impl.register(Kernel)
def _type_of_kernel(kernel: Kernel, context: Any) -> Any:
    """Return the type that compiled code sees when it calls a kernel."""
    if kernel not in _parts:
        own: dict[str, Any] = {"forceinline": True} if kernel.is_inlined else {}
        own |= {"fastmath": False} if kernel.is_exact else {}
        _parts[kernel] = njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, **OPTIONS | own)(kernel.__wrapped__)
    return _Part(_parts[kernel])


def code_of(function: Callable[..., Any], signature: Any, name: str) -> Any:
    """Return a module of LLVM's with a function of a signature, called from C by the name, and with all that it calls."""
    made = cfunc(signature, **OPTIONS)(function)
    module = llvm.parse_assembly(made.inspect_llvm())
    set_linkage(module, {one for one in llvm.Linkage if one is not llvm.Linkage.internal}, llvm.Linkage.internal)
    outer = module.get_function(made.native_name)
    outer.linkage, outer.name = llvm.Linkage.external, name
    return module
