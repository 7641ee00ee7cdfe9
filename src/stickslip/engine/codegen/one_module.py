"""How numba compiles the engine: all functions that an entry point calls go into one module, which is optimised once.

Left to itself numba makes machine code and wrappers of every function, optimises each together with all that it calls, and does so
again at every level of calls. Here a function that is called from compiled code becomes typed, unoptimised code and nothing more;
only a function that is called from Python is linked with all that it needs, optimised, turned into machine code and kept on disk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import llvmlite.binding as llvm
from numba import njit, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.extending import typeof_impl

from stickslip.engine.codegen.cache import SealedCache

OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "fastmath": {"contract"}, "no_cfunc_wrapper": True}


class Part(JITCodeLibrary):  # type: ignore[misc] # numba is untyped
    """The code of one function that others call: neither linked, nor optimised, nor turned into machine code."""

    def finalize(self) -> None:
        """Add nothing any more; what the function calls is linked by the module that it ends in."""
        self._raise_if_finalized()
        self._finalized = True

    @property
    def codegen(self) -> Any:
        """The code generator, for which functions without machine code have no environment either."""
        return _WithoutEnvironments(self._codegen)

    def enable_object_caching(self) -> None:
        """There is no machine code to keep."""

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no machine code to point to."""
        self._ensure_finalized()
        return 0

    def own_module(self) -> Any:
        """Return the code of this function alone, which may be linked several times."""
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """Return the code of this function with all that it calls, for modules that are not made here."""
        module = self.own_module().clone()
        below = list(parts_below(self._linking_libraries))
        for part in below:
            module.link_in(part.own_module(), preserve=True)
        for library in others_of([self, *below]):
            module.link_in(library._get_module_for_linking(), preserve=True)
        return module


class _WithoutEnvironments:
    """A code generator that does not look for a function's environment in machine code."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing: only what is called from Python has an environment."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class Whole(JITCodeLibrary):  # type: ignore[misc]
    """The module of a function that is called from Python: every part that it needs is linked once."""

    def finalize(self) -> None:
        """Link, optimise and make machine code."""
        linked: list[Any] = list(vars(self)["_linking_libraries"])
        parts = list(parts_below(linked))
        for part in parts:
            self._final_module.link_in(part.own_module(), preserve=True)
        self._linking_libraries = others_of([self, *parts])
        super().finalize()

    def _optimize_final_module(self) -> None:
        """Let nobody else see the parts, so that what is inlined everywhere leaves nothing behind."""
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == llvm.Linkage.linkonce_odr:
                function.linkage = llvm.Linkage.internal
        super()._optimize_final_module()


def parts_below(libraries: list[Any]) -> Iterator[Part]:
    """Yield the parts among some libraries, and all those that they call, each once."""
    seen: set[int] = set()
    waiting = list(libraries)
    while waiting:
        library = waiting.pop()
        if isinstance(library, Part) and id(library) not in seen:
            seen.add(id(library))
            yield library
            waiting += library._linking_libraries


def others_of(libraries: list[Any]) -> list[Any]:
    """Return what some libraries need that is no part: numba's own functions, each once."""
    needed = [one for library in libraries for one in vars(library)["_linking_libraries"] if not isinstance(one, Part)]
    return list({id(one): one for one in needed}.values())


class PartCompiler(Compiler):  # type: ignore[misc]
    """Compiles a function into a `Part`."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        super().__init__(typingctx, targetctx, library or Part(targetctx.codegen(), "part"), *rest)


class WholeCompiler(Compiler):  # type: ignore[misc]
    """Compiles a function into a `Whole`."""

    def __init__(self, typingctx: Any, targetctx: Any, library: Any, *rest: Any) -> None:
        library = Whole(targetctx.codegen(), "whole")
        library.enable_object_caching()
        super().__init__(typingctx, targetctx, library, *rest)


class Kernel:
    """A compiled function: an entry point where Python calls it, a part where compiled code does."""

    def __init__(self, function: Callable[..., Any], **options: bool) -> None:
        self.__doc__, self.__name__, self.__module__ = function.__doc__, function.__name__, function.__module__
        self.__wrapped__ = function
        self.part: Any = njit(pipeline_class=PartCompiler, no_cpython_wrapper=True, **OPTIONS, **options)(function)
        self.entry: Any = njit(pipeline_class=WholeCompiler, **OPTIONS)(function)
        self.entry._cache = SealedCache(function)

    def __call__(self, *arguments: Any) -> Any:
        """Call the machine code; compile it the first time."""
        return self.entry(*arguments)


@typeof_impl.register(Kernel)
def _type_of_kernel(kernel: Kernel, context: Any) -> Any:
    return types.Dispatcher(kernel.part)
