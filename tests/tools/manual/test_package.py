from pathlib import Path

from manual.package import regular


def test_copy_is_a_package_all_through(tmp_path: Path) -> None:
    package = tmp_path / "own"
    (package / "laws" / "__pycache__").mkdir(parents=True)
    (package / "__init__.py").write_text("x = 1\n")
    (package / "laws" / "exact.py").write_text("y = 2\n")
    (package / "laws" / "arm.xml").write_text("<mujoco/>")
    place = regular(package, tmp_path / "build")
    copied = {f.relative_to(place).as_posix() for f in place.rglob("*") if f.is_file()}
    assert copied == {"own/__init__.py", "own/laws/__init__.py", "own/laws/exact.py"}
    assert (place / "own" / "__init__.py").read_text() == "x = 1\n"
    (package / "laws" / "exact.py").unlink()
    assert not list(regular(package, place).rglob("exact.py"))
