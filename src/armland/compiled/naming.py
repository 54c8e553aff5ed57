"""A record's type is named after its layout, so that compiled code for two layouts is never mixed up.

Numba names a compiled function after its arguments' types, and a record's type after the number that it has in the process:
code that two processes compiled for different records can bear the same name in the cache, and a third process that loads both
calls one of them for the other, which reads the wrong bytes.
"""

import hashlib
from typing import Any


def name_records_by_layout() -> None:
    """Make Numba name a record's type after its fields, offsets and size; to be called before anything is compiled.

    The name is short: that of a record of records would fill pages, and stands in each file of the cache.
    """
    from numba.core import types

    if hasattr(types.Record, "spelt_out"):
        return
    spell_out = types.Record.__init__

    def shortened(self: Any, fields: Any, size: int, aligned: bool) -> None:
        spell_out(self, fields, size, aligned)
        self.name = f"Record({hashlib.sha256(self.name.encode()).hexdigest()})"

    types.Record.spelt_out = spell_out  # type: ignore[attr-defined]
    types.Record.__init__ = shortened  # type: ignore[method-assign]
    types.Record.mangling_args = property(lambda self: (type(self).__name__, (self.name[7:-1],)))  # type: ignore
