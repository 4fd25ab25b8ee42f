"""Signatures of the compiled functions and classes, so that inspect.signature() shows their arguments."""

from __future__ import annotations

from typing import Any

from . import _core


class _Source:
    """A default that is shown as it is written."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def _parsed(text: str, defaults: tuple[Any, ...]) -> Any:
    """The signature that a line "def name(self, time: float = 0.0) -> None" is."""
    import ast
    import inspect
    import re

    for place, value in enumerate(defaults or ()):
        text = text.replace(f"\\{place}", repr(value) if isinstance(value, (int, float, str, bool)) else "...")
    source: Any = ast.parse(re.sub(r"\bcarom\._core\.", "carom.", text) + ": ...").body[0]
    given = source.args
    kinds = inspect.Parameter

    def value_of(node: Any) -> Any:
        if node is None:
            return kinds.empty
        try:
            return ast.literal_eval(node)
        except ValueError:
            return _Source(ast.unparse(node))

    def made(argument: Any, kind: Any, default: Any) -> Any:
        annotation = kinds.empty if argument.annotation is None else ast.unparse(argument.annotation)
        return kinds(argument.arg, kind, default=value_of(default), annotation=annotation)

    positional = [*given.posonlyargs, *given.args]
    first = [None] * (len(positional) - len(given.defaults)) + list(given.defaults)
    parameters = []
    for i, (argument, default) in enumerate(zip(positional, first)):
        only = i < len(given.posonlyargs)
        kind = kinds.POSITIONAL_ONLY if only else kinds.POSITIONAL_OR_KEYWORD
        parameters.append(made(argument, kind, default))
    if given.vararg is not None:
        parameters.append(made(given.vararg, kinds.VAR_POSITIONAL, None))
    for argument, default in zip(given.kwonlyargs, given.kw_defaults):
        parameters.append(made(argument, kinds.KEYWORD_ONLY, default))
    if given.kwarg is not None:
        parameters.append(made(given.kwarg, kinds.VAR_KEYWORD, None))
    result = inspect.Signature.empty if source.returns is None else ast.unparse(source.returns)
    return inspect.Signature(parameters, return_annotation=result)


def of_function(function: Any) -> Any:
    """Signature of a compiled function; of several that share a name that with most arguments."""
    overloads = [_parsed(entry[0], entry[2]) for entry in function.__nb_signature__]
    return max(overloads, key=lambda signature: len(signature.parameters))


def _without_self(signature: Any) -> Any:
    return signature.replace(parameters=list(signature.parameters.values())[1:])


def of_bound(method: Any) -> Any:
    """Signature of a compiled method of an object."""
    return _without_self(of_function(method))


class _OfClass:
    """The attribute __signature__ of compiled classes."""

    def __get__(self, instance: Any, owner: Any = None) -> Any:
        import inspect

        begin = getattr(owner, "__init__", None)
        if instance is not None or not hasattr(begin, "__nb_signature__"):
            raise AttributeError("__signature__")  # of a class in Python, which has its own
        signature = _without_self(of_function(begin))
        return signature.replace(return_annotation=inspect.Signature.empty)


def install() -> None:
    """Makes inspect.signature() know what the compiled part of the package takes."""
    for compiled, signature in (
        (_core.force_on, of_function),
        (_core.Simulation.step, of_function),
        (_core.System().body, of_bound),
    ):
        _core._set_in_type(type(compiled), "__signature__", property(signature))
    for module in (_core, _core.planar, _core.spatial):
        for value in vars(module).values():
            if isinstance(value, type) and isinstance(value, type(_core.System)):
                value.__signature__ = _OfClass()  # type: ignore[attr-defined, unused-ignore]
