"""Care for compiled code: that it is never stale nor mixed up, that a broken cache stops nothing, that it is compiled
once and fast.

| module | what |
|---|---|
| `stamps` | compiled code goes when anything that it was compiled from has changed |
| `naming` | a record's type is named after its layout |
| `keeping` | a torn or unwritable cache ends in compilation, not in a traceback |
| `inner` | what is called by compiled code alone is optimised and emitted once, with its caller |
| `stack` | small arrays that stay in a function cost neither memory nor reference counts |
| `warming` | what a flight needs is compiled beforehand, in processes side by side |
"""

from armland.compiled.stamps import drop_stale

__all__ = ["drop_stale", "set_up"]


def set_up() -> None:
    """Teach Numba all that; to be called before anything is compiled. A second call does nothing."""
    from armland.compiled import inner, keeping, naming

    naming.name_records_by_layout()
    keeping.forgive()
    inner.defer()
