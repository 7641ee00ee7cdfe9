"""Every private name of numba that the package uses, in one place, with a fallback if one of them is missing.

Numba promises nothing about these names. Those that define the types of records and lanes have been the same for ten years, and
nothing can replace them. The others only make the first start faster: if one is missing or has changed, numba's public compiler and
its own cache take over, and `WHY_PLAIN` says why.
"""

from __future__ import annotations

import inspect
import os
from typing import Any

import numba

from stickslip.engine.compile.uncompiled import UNCOMPILED
from stickslip.foundation.errors import InputError

WHY_PLAIN = ""
"""Why numba's public compiler is used; empty if the faster way works."""


def _has(owner: Any, *names: str) -> None:
    """Raise ImportError if a class or an object lacks one of the attributes that are used or replaced."""
    for name in names:
        if not hasattr(owner, name):
            raise ImportError(f"{getattr(owner, '__name__', type(owner).__name__)} has no {name}")


def _takes(function: Any, *names: str) -> None:
    """Raise ImportError if a function does not take the given parameters, in this order and before all others."""
    found = tuple(inspect.signature(function).parameters)[: len(names)]
    if found != names:
        raise ImportError(f"{function.__qualname__} takes {', '.join(found)}")


AbstractTemplate: Any = object
AttributeTemplate: Any = object
infer_getattr: Any = lambda one: one  # noqa: E731  # stands for numba's function, as the next ones do
infer_global: Any = lambda _: lambda one: one  # noqa: E731
signature: Any = lambda *_: None  # noqa: E731

if not UNCOMPILED:
    try:
        from numba import extending
        from numba.core.typing import templates

        AbstractTemplate, AttributeTemplate = templates.AbstractTemplate, templates.AttributeTemplate
        infer_getattr, infer_global, signature = extending.infer_getattr, templates.infer_global, templates.signature
    except (ImportError, AttributeError) as error:
        raise InputError(
            f"numba {numba.__version__} cannot compile the engine ({error}); 0.62 to 0.68 can: pip install 'numba>=0.62,<0.69'"
        ) from None

    try:
        if os.environ.get("STICKSLIP_PLAIN_NUMBA", "") not in ("", "0"):
            raise ImportError("STICKSLIP_PLAIN_NUMBA is set")
        import llvmlite.binding as llvm
        from llvmlite.binding import ffi
        from llvmlite.ir import Type
        from numba.core import base, errors, lowering, typeinfer
        from numba.core.caching import NullCache
        from numba.core.codegen import JITCodeLibrary
        from numba.core.compiler import Compiler, CompileResult
        from numba.core.ir import Assign, Inst, Loc, Var
        from numba.core.lowering import Lower
        from numba.core.postproc import PostProcessor, VariableLifetime
        from numba.core.runtime import rtsys
        from numba.core.runtime.context import NRTContext
        from numba.core.serialize import dumps
        from numba.core.transforms import canonicalize_cfg
        from numba.core.typed_passes import IRLegalization, NativeLowering, NoPythonBackend, NopythonTypeInference
        from numba.core.types import Function
        from numba.core.typing.context import BaseContext
        from numba.core.untyped_passes import FixupArgs, GenericRewrites, IRProcessing, TranslateByteCode

        LLVM_LOCK, WarningsFixer = ffi.lib._lock, errors.WarningsFixer  # type: ignore[attr-defined] # numba's stubs lack it

        _has(JITCodeLibrary, "finalize", "_optimize_final_module", "_get_module_for_linking", "_raise_if_finalized")
        _has(NullCache, "load_overload", "save_overload")
        _has(CompileResult, "_reduce", "_rebuild")
        _has(Compiler, "define_pipelines", "compile_extra")
        _has(rtsys, "initialize")
        _has(LLVM_LOCK, "_cblist")
        _has(llvm, "get_process_triple")
        _has(lowering, "new_error_context")
        _has(typeinfer, "new_error_context")
        _has(WarningsFixer, "catch_warnings")
        _has(Lower, "typeof", "getvar", "_alloca_var", "_find_singly_assigned_variable")
        _takes(Function.get_call_type, "self", "context", "args", "kws")
        _takes(Type.get_abi_size, "self", "target_data", "context")
        _takes(BaseContext.resolve_getattr, "self", "typ", "attr")
        _takes(BaseContext.resolve_value_type, "self", "val")
        _takes(Lower.storevar, "self", "value", "name", "argidx")
        _takes(PostProcessor.run, "self", "emit_dels", "extend_lifetimes")
        _takes(VariableLifetime, "blocks")
        _takes(base._has_loc, "fn")
        _takes(canonicalize_cfg, "blocks")
        _takes(Loc.strformat, "self")
        _takes(Inst._rec_list_vars, "self", "val")
        _takes(NRTContext._call_incref_decref, "self", "builder", "typ", "value", "funcname")
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        WHY_PLAIN = " ".join(str(error).split())

__all__ = [
    "LLVM_LOCK",
    "WHY_PLAIN",
    "AbstractTemplate",
    "Assign",
    "AttributeTemplate",
    "BaseContext",
    "CompileResult",
    "Compiler",
    "FixupArgs",
    "Function",
    "GenericRewrites",
    "IRLegalization",
    "IRProcessing",
    "Inst",
    "JITCodeLibrary",
    "Loc",
    "Lower",
    "NRTContext",
    "NativeLowering",
    "NoPythonBackend",
    "NopythonTypeInference",
    "NullCache",
    "PostProcessor",
    "TranslateByteCode",
    "Type",
    "Var",
    "VariableLifetime",
    "WarningsFixer",
    "base",
    "canonicalize_cfg",
    "dumps",
    "infer_getattr",
    "infer_global",
    "llvm",
    "lowering",
    "rtsys",
    "signature",
    "typeinfer",
]
