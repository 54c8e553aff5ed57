"""Small arrays move to the stack where they cannot outlive their function, and stay where they can."""

import numpy as np
import pytest

from armland.compiled.stack import embeddable, put_on_stack
from armland.rotations import cross, rotation_error

MADE = "  %m = tail call ptr @NRT_MemInfo_alloc_aligned(i64 24, i32 32)\n"
READ = "  %d = tail call ptr @NRT_MemInfo_data_fast(ptr nonnull %m)\n  %x = load double, ptr %d, align 8\n"
DROPPED = "  tail call void @NRT_decref(ptr nonnull %m)\n"


def function(body: str) -> str:
    return f"declare void @g(ptr)\n\ndefine double @f(ptr %out) {{\n{MADE}{READ}{body}{DROPPED}  ret double %x\n}}\n"


def test_a_local_array_moves() -> None:
    code = put_on_stack(function(""))
    assert code is not None
    assert "alloca" in code
    assert "NRT_MemInfo_alloc_aligned" not in code
    assert "NRT_decref" not in code
    # A tail call is taken to leave the stack alone.
    assert "tail call" not in code


@pytest.mark.parametrize(
    "use",
    [
        "  store ptr %m, ptr %out, align 8\n",
        "  call void @g(ptr %m)\n",
        "  %p = select i1 true, ptr %m, ptr %out\n",
    ],
)
def test_an_array_that_may_live_on_stays(use: str) -> None:
    assert put_on_stack(function(use)) is None


def test_an_array_of_unknown_size_stays() -> None:
    assert put_on_stack(function("").replace("i64 24", "i64 %n")) is None


def test_a_function_called_once_is_embedded_however_long() -> None:
    lines = "  call void @g(ptr null)\n" * 5000
    code = f"define void @long() {{\n{lines}  ret void\n}}\n\ndefine void @f() {{\n  call void @long()\n"
    assert "long" in embeddable(code + "  ret void\n}\n")
    assert "long" not in embeddable(code + "  call void @long()\n  ret void\n}\n")


def test_results_are_arrays_of_their_own() -> None:
    a, b = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    first, second = cross(a, b), cross(b, a)
    np.testing.assert_array_equal(first, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(second, [0.0, 0.0, -1.0])
    np.testing.assert_array_equal(rotation_error(np.eye(3), np.eye(3)), np.zeros(3))
