"""Compile kernels with numba in a third of its time: skip what our code never needs, and make one module for each entry point.

By default numba makes machine code and wrappers of every function, and optimises each one together with all functions that it
calls, again at every level of calls. Here a function that is called from compiled code becomes typed, unoptimised code and nothing
more. Only a function that is called from Python is linked with everything that it needs, optimised, turned into machine code and
kept on disk.
What numba does again and again meanwhile is done once (see `shortcuts`).
"""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Iterator
from typing import Any, ClassVar

import llvmlite.binding as llvm
from numba import njit

from stickslip.engine.compile import cache
from stickslip.engine.compile.cache import CACHE, NOTICED, OTHERS, SLOW, Kept
from stickslip.engine.compile.numba_privates import (
    Compiler,
    CompileResult,
    FixupArgs,
    GenericRewrites,
    IRLegalization,
    IRProcessing,
    JITCodeLibrary,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    NullCache,
    TranslateByteCode,
    dumps,
    rtsys,
)
from stickslip.foundation.sealed_files import tell

PASSES = tuple(
    one()
    for one in (
        TranslateByteCode,
        FixupArgs,
        IRProcessing,
        GenericRewrites,
        NopythonTypeInference,
        IRLegalization,
        NativeLowering,
        NoPythonBackend,
    )
)
"""Passes of numba's compiler that our code needs: it has no closures, array expressions, `with` statements or exceptions, and no
branch that is never taken. The pass that gives a variable a name of its own for each assignment is left to LLVM, which does the
same faster. Without it all values of a variable have one type. A whole number may become a float, but what begins as a constant of
its module, such as `found = NOTHING`, stays that constant: numba refuses to compile another value."""


class Passes:
    """The order of passes, as numba's compiler asks for it."""

    pipeline_name = "lean"
    exec_times: ClassVar[dict[str, Any]] = {}

    def run(self, state: Any) -> None:
        """Compile what is in `state`. Ends of variables are written only if some hold references that are counted."""
        from stickslip.engine.compile.shortcuts import is_counted

        for one in PASSES:
            if not isinstance(one, IRLegalization) or any(is_counted(state.targetctx, kind) for kind in state.typemap.values()):
                one.run_pass(state)


class LeanCompiler(Compiler):  # type: ignore[misc] # numba is untyped
    """Numba's compiler without what our code does not need."""

    def define_pipelines(self) -> list[Any]:
        """Return the order of passes."""
        return [Passes()]

    def compile_extra(self, function: Any) -> Any:
        """Compile a function, with all that it calls."""
        from stickslip.engine.compile.shortcuts import at_speed  # machine code from the disk needs none

        with at_speed():
            return super().compile_extra(function)


class FunctionCode(JITCodeLibrary):  # type: ignore[misc] # numba is untyped
    """The code of one function that others call. It is not linked, not optimised and not turned into machine code."""

    def finalize(self) -> None:
        """Close the library without linking anything; the `Whole` that includes this function links the functions that it calls.

        The linkage is weak: a linker may drop a function of linkage "linkonce" that nobody has asked for yet, and a part that is
        linked later may ask for it.
        """
        self._raise_if_finalized()
        for before in (llvm.Linkage.external, llvm.Linkage.linkonce_odr):
            set_linkage(self._final_module, before, llvm.Linkage.weak_odr)
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
        """Return the code of this function with all functions that it calls, for modules of numba's own kind."""
        module = self.own_module().clone()
        below = list(parts_below(self._linking_libraries))
        for part in below:
            module.link_in(part.own_module(), preserve=True)
        for library in others_of([self, *below]):
            module.link_in(library._get_module_for_linking(), preserve=True)
        set_linkage(module, llvm.Linkage.weak_odr, llvm.Linkage.linkonce_odr)
        return module


class _WithoutEnvironments:
    """A code generator that does not look for a function's environment in machine code."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing, because only functions that are called from Python have an environment."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class Whole(JITCodeLibrary):  # type: ignore[misc]
    """The module of a function that is called from Python. Every part that it needs is linked into it once."""

    def finalize(self) -> None:
        """Link the parts and numba's own functions, optimise, and make machine code."""
        linked: list[Any] = list(vars(self)["_linking_libraries"])
        parts = list(parts_below(linked))
        for part in parts:
            self._final_module.link_in(part.own_module(), preserve=True)
        self._linking_libraries = others_of([self, *parts])
        super().finalize()

    def _optimize_final_module(self) -> None:
        """Hide the parts from other modules, so that a function that is inlined everywhere is dropped; then optimise."""
        for before in (llvm.Linkage.linkonce_odr, llvm.Linkage.weak_odr):
            set_linkage(self._final_module, before, llvm.Linkage.internal)
        super()._optimize_final_module()


def set_linkage(module: Any, before: Any, after: Any) -> None:
    """Change the linkage of the functions that a module defines."""
    for function in module.functions:
        if not function.is_declaration and function.linkage == before:
            function.linkage = after


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


class PartCompiler(LeanCompiler):
    """Compiles a function into a `FunctionCode`."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        super().__init__(typingctx, targetctx, library or FunctionCode(targetctx.codegen(), "part"), *rest)


class WholeCompiler(LeanCompiler):
    """Compiles a function into a `Whole`."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        library = Whole(targetctx.codegen(), "whole")
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, *rest)


class _Wait:
    """What this process has spent on compilation (processor time, s), and what its user has been told."""

    spent, began = 0.0, 0.0
    announced: ClassVar[set[str]] = set()

    @classmethod
    def begin(cls, name: str) -> None:
        """Begin to compile a function, and say so if its user has to wait and does not know."""
        message = SLOW.get(name, "")
        if not message and cls.spent > NOTICED and not cls.announced:
            is_new = CACHE is None or not any(CACHE.glob("loop.run_until-*"))
            message = SLOW["run_until"] if is_new else OTHERS
        if message and message not in cls.announced:
            cls.announced.add(message)
            cache.announce(message)
        cls.began = time.process_time()


class KernelCache(NullCache):  # type: ignore[misc]
    """The machine code of one function on disk, which numba's dispatcher asks for before it compiles."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    def _kept(self, signature: Any, code: Any) -> Kept:
        """Return the file of the machine code for a signature; `code` makes code for this processor."""
        function = self._function
        name = f"{function.__module__.rsplit('.', 1)[-1]}.{function.__name__.strip('<>')}"
        text = f"{function.__module__} {function.__qualname__} {signature} {code.magic_tuple()} {function.__code__.co_code.hex()}"
        return Kept(name, text)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the compiled function, or None if it must be compiled; announce the compilation if it takes long (see SLOW).

        numba's own method first makes ready all that it needs to compile (`context.refresh()`), which takes half a second. Machine
        code from the disk needs the run-time functions only. The compiler calls `refresh` itself before it compiles anything.
        """
        rtsys.initialize(context)
        content = self._kept(signature, context.codegen()).read()
        if content is None:
            _Wait.begin(self._function.__name__)
            return None
        try:
            return CompileResult._rebuild(context, *pickle.loads(content))
        except Exception as error:  # unpickling may raise anything, and must not make every later start fail
            tell(f"compiled code in {CACHE} cannot be used ({type(error).__name__}): it is compiled again")
            return None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Keep a compiled function for later starts."""
        _Wait.spent += time.process_time() - _Wait.began
        if not result.library.has_dynamic_globals:  # no address of this process
            self._kept(signature, result.codegen).write(dumps(result._reduce()))


def dispatchers(function: Callable[..., Any], entry: dict[str, Any], part: dict[str, Any]) -> tuple[Any, Any]:
    """Return what compiled code calls, a `FunctionCode`, and what Python calls, a `Whole` that is kept in the cache."""
    called: Any = njit(pipeline_class=PartCompiler, no_cpython_wrapper=True, **entry, **part)(function)
    whole: Any = njit(pipeline_class=WholeCompiler, **entry)(function)
    whole._cache = KernelCache(function)
    return called, whole
