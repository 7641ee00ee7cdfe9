"""Turn the text of a formula's function into machine code, by llvmlite's public interface: for floats, and for lanes (see `simd`).

The text consists of assignments (see `taylor_series`). The functions that it calls are written from their own Python source, which
may also have `if` with a `return`, and conditional expressions. All instructions are those that numba writes for the same text, so
that both give the same bits. In lanes the same instructions work on vectors; a function of the mathematical library, and a function
with decisions, is called for one lane after the other.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping, Sequence
from functools import reduce
from typing import Any

import llvmlite.binding as llvm
import llvmlite.ir as ir

from stickslip.foundation.kernels.code import Kept, loaded
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.foundation.kernels.processor import PROCESSOR

VECTOR = ir.VectorType(ir.DoubleType(), SIMD_WIDTH)
FUSED = ("contract",)
"""Flags of instructions: a product and a sum may be fused into one operation, as in kernels (`kernels.OPTIONS`)."""
NUMBER, PLACE, WHOLE, NOTHING = ir.DoubleType(), ir.IntType(32), ir.IntType(64), ir.VoidType()
OF_LLVM = {"abs": "fabs", "sqrt": "sqrt", "floor": "floor"}
"""Functions that processors have, and LLVM's names of them."""
OF_LIBRARY = {name: f"llvm.{name}.f64" for name in ("sin", "cos", "exp", "log")}
OF_LIBRARY |= {name: name for name in ("expm1", "log1p", "tanh", "asinh", "sinh", "cosh")}
"""Functions of the mathematical library, and the names by which numba calls them."""
OPERATORS: dict[type, str] = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
SIGNS: dict[type, str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


class MachineCode:
    """A function in machine code, with its `address`; the code lives as long as this object."""

    def __init__(self, statements: Sequence[str], arguments: Sequence[str], lanes: bool, names: Mapping[str, Any]) -> None:
        """Compile a function without result from its statements, or take it from the cache.

        Arguments are arrays if they are marked by [], otherwise floats; `names` has what the statements call.
        """
        kept = Kept("formula", "\n".join([str(lanes), ", ".join(arguments), *statements]))
        code = kept.read()
        if code is None:
            code = _object_code(statements, arguments, VECTOR if lanes else NUMBER, names)
            kept.write(code)
        self._engine = loaded(code)
        self.address = int(self._engine.get_function_address("formula"))


def _object_code(statements: Sequence[str], arguments: Sequence[str], kind: ir.Type, names: Mapping[str, Any]) -> bytes:
    """Return the optimised machine code of a function named `formula`, as an object file."""
    module = ir.Module()
    types = [kind.as_pointer() if name.endswith("[]") else kind for name in arguments]
    function = ir.Function(module, ir.FunctionType(NOTHING, types), "formula")
    body = _Body(function, kind, [name.strip("[]") for name in arguments], names)
    body.write(ast.parse("\n".join(statements)).body)
    body.builder.ret_void()
    module.triple, module.data_layout = llvm.get_process_triple(), str(PROCESSOR.machine().target_data)
    return PROCESSOR.optimised(llvm.parse_assembly(str(module)))


class _Body:
    """Writes the body of a function, whose numbers are floats or lanes (`kind`), from statements of Python."""

    def __init__(self, function: ir.Function, kind: ir.Type, arguments: Sequence[str], names: Mapping[str, Any]) -> None:
        self.function, self.kind, self.names = function, kind, names
        self.builder = ir.IRBuilder(function.append_basic_block())
        self.values: dict[str, Any] = dict(zip(arguments, function.args, strict=True))

    # ---- statements ---------------------------------------------------------------------------------------------------------

    def write(self, statements: Sequence[ast.stmt]) -> None:
        """Write statements, one after the other."""
        for statement in statements:
            match statement:
                case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Tuple(elts=values)):
                    for target, value in zip(targets, [self.number(one) for one in values], strict=True):
                        self._assign(target, value)
                case ast.Assign(targets=[target], value=value):
                    self._assign(target, self.number(value))
                case ast.AugAssign(target=ast.Name(id=name), op=op, value=value):
                    self.values[name] = self._operation(op, self.values[name], self.number(value))
                case ast.If(test=test, body=body, orelse=[]):  # the body ends with a return
                    yes, no = (self.function.append_basic_block() for _ in range(2))
                    self.builder.cbranch(self.condition(test), yes, no)
                    self.builder.position_at_end(yes)
                    self.write(body)
                    self.builder.position_at_end(no)
                case ast.Return(value=ast.expr() as value):
                    self.builder.ret(self.number(value))
                case ast.Expr(value=ast.Constant()):
                    pass  # a docstring
                case _:
                    raise NotImplementedError(ast.unparse(statement))

    def _assign(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self.values[target.id] = value
        else:
            self.builder.store(value, self._place(target))

    def _place(self, target: ast.expr) -> Any:
        """Write the address of a number in an array."""
        match target:
            case ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=place)):
                return self.builder.gep(self.values[name], [ir.Constant(WHOLE, place)])
        raise NotImplementedError(ast.unparse(target))

    # ---- expressions --------------------------------------------------------------------------------------------------------

    def number(self, node: ast.expr) -> Any:
        """Write an expression whose value is a number."""
        match node:
            case ast.Name(id=name) if name in self.values:
                return self.values[name]
            case ast.Subscript(value=ast.Name(id=name)) if name in self.values:
                return self.builder.load(self._place(node))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.builder.fneg(self.number(operand))
            case ast.BinOp(left=left, op=op, right=right):
                return self._operation(op, self.number(left), self.number(right))
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._either(test, body, other)
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=arguments):
                return self._call(name, [self.number(one) for one in arguments])
        return self._constant(float(self._known(node)))

    def _known(self, node: ast.expr) -> Any:
        """Return what an expression refers to: a number, or a name of the function's module, such as a tuple of constants."""
        match node:
            case ast.Constant(value=value):
                return value
            case ast.Name(id=name):
                return self.names[name]
            case ast.Attribute(value=value, attr=name):
                return getattr(self._known(value), name)
            case ast.Subscript(value=value, slice=place):
                return self._known(value)[self._known(place)]
        raise NotImplementedError(ast.unparse(node))

    def _constant(self, number: float) -> Any:
        return ir.Constant(self.kind, [number] * SIMD_WIDTH if self.kind == VECTOR else number)

    def _operation(self, op: ast.operator, a: Any, b: Any) -> Any:
        if isinstance(op, ast.Pow):
            return self._by_library("llvm.pow.f64", [a, b])
        return getattr(self.builder, OPERATORS[type(op)])(a, b, flags=FUSED)

    def condition(self, node: ast.expr) -> Any:
        """Write a comparison of floats, or several that are joined by `and` or `or`."""
        match node:
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                return self.builder.fcmp_ordered(SIGNS[type(op)], self.number(left), self.number(right))
            case ast.BoolOp(op=op, values=values):
                join = self.builder.or_ if isinstance(op, ast.Or) else self.builder.and_
                return reduce(join, [self.condition(one) for one in values])
        raise NotImplementedError(ast.unparse(node))

    def _either(self, test: ast.expr, body: ast.expr, other: ast.expr) -> Any:
        """Write a conditional expression that evaluates only one of its sides."""
        yes, no, after = (self.function.append_basic_block() for _ in range(3))
        self.builder.cbranch(self.condition(test), yes, no)
        sides = []
        for block, side in ((yes, body), (no, other)):
            self.builder.position_at_end(block)
            sides.append((self.number(side), self.builder.block))
            self.builder.branch(after)
        self.builder.position_at_end(after)
        found = self.builder.phi(self.kind)
        for value, block in sides:
            found.add_incoming(value, block)
        return found

    # ---- calls --------------------------------------------------------------------------------------------------------------

    def _call(self, name: str, given: list[Any]) -> Any:
        if name in ("min", "max"):
            sign = "<" if name == "min" else ">"
            return reduce(lambda a, b: self.builder.select(self.builder.fcmp_ordered(sign, b, a), b, a), given)
        if name in OF_LLVM:
            return self._by_llvm(OF_LLVM[name], given)
        if name == "fused":
            return self._by_llvm("fmuladd", given)
        if name == "power_of_two":
            return self._power_of_two(given[0])
        if name in OF_LIBRARY:
            return self._by_library(OF_LIBRARY[name], given)
        return self._by_helper(self.names[name], given)

    def _by_llvm(self, name: str, given: list[Any]) -> Any:
        """Write the call of a function that LLVM has for floats and for vectors."""
        ending = f"v{SIMD_WIDTH}f64" if self.kind == VECTOR else "f64"
        return self._to(_declared(self.function.module, f"llvm.{name}.{ending}", self.kind, len(given)), given)

    def _by_library(self, name: str, given: list[Any]) -> Any:
        return self._each_by_itself(_declared(self.function.module, name, NUMBER, len(given)), given)

    def _by_helper(self, helper: Any, given: list[Any]) -> Any:
        """Write the call of a function that is written in Python, and the function itself where it is new to the module."""
        function = inspect.unwrap(helper)
        source = ast.parse(inspect.getsource(function)).body[0]
        assert isinstance(source, ast.FunctionDef)
        decides = any(isinstance(one, ast.If | ast.IfExp) for one in ast.walk(source))
        kind = NUMBER if decides else self.kind
        name = f"{function.__module__}.{function.__name__}"
        made = self.function.module.globals.get(name)
        if made is None:
            made = ir.Function(self.function.module, ir.FunctionType(kind, [kind] * len(given)), name)
            made.linkage = "internal"
            _Body(made, kind, [one.arg for one in source.args.args], function.__globals__).write(source.body)
        return self._each_by_itself(made, given) if decides else self._to(made, given)

    def _to(self, function: Any, given: list[Any]) -> Any:
        return self.builder.call(function, given, fastmath=FUSED)

    def _each_by_itself(self, function: Any, given: list[Any]) -> Any:
        """Write the call of a function of floats; in lanes, one call for each."""
        if self.kind == NUMBER:
            return self._to(function, given)
        result: Any = ir.Constant(VECTOR, ir.Undefined)
        for n in range(SIMD_WIDTH):
            place = ir.Constant(PLACE, n)
            one = self._to(function, [self.builder.extract_element(x, place) for x in given])
            result = self.builder.insert_element(result, one, place)
        return result

    def _power_of_two(self, n: Any) -> Any:
        """Write 2^n for a whole number n that is given as a float (see `simd.power_of_two`)."""
        whole = ir.VectorType(WHOLE, SIMD_WIDTH) if self.kind == VECTOR else WHOLE
        bias, places = (ir.Constant(whole, [x] * SIMD_WIDTH if self.kind == VECTOR else x) for x in (1023, 52))
        biased = self.builder.add(self.builder.fptosi(n, whole), bias)
        return self.builder.bitcast(self.builder.shl(biased, places), self.kind)


def _declared(module: ir.Module, name: str, kind: ir.Type, count: int) -> Any:
    """Return a function of LLVM or of the mathematical library, which has no effects."""
    if name not in module.globals:
        function = ir.Function(module, ir.FunctionType(kind, [kind] * count), name)
        if not name.startswith("llvm."):
            function.attributes.add("readonly")
            function.attributes.add("nounwind")
    return module.globals[name]
