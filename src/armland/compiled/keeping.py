"""A cache that cannot be used stops nothing: what is torn counts as missing, what cannot be kept is compiled again next time."""

from collections.abc import Callable
from typing import Any


def forgive() -> None:
    """Make Numba compile where it would raise over its cache: a torn file, a full disk, no folder to write to."""
    from numba.core import caching, dispatcher

    if getattr(caching.Cache.load_overload, "forgiving", False):
        return
    files = caching.IndexDataCacheFile
    files._load_index = _or(files._load_index, dict)  # type: ignore[method-assign]
    caching.Cache.load_overload = _or(caching.Cache.load_overload, lambda: None)  # type: ignore[method-assign]
    caching.Cache.save_overload = _or(caching.Cache.save_overload, lambda: None)  # type: ignore[method-assign]
    dispatcher.Dispatcher.enable_caching = _or(  # type: ignore[method-assign]
        dispatcher.Dispatcher.enable_caching, lambda: None
    )


def _or(method: Callable[..., Any], instead: Callable[[], Any]) -> Callable[..., Any]:
    def forgiving(self: Any, *arguments: Any) -> Any:
        try:
            return method(self, *arguments)
        except Exception:
            # Unpickling what is torn can raise anything.
            return instead()

    forgiving.forgiving = True  # type: ignore[attr-defined]
    return forgiving
