"""XML as people write it."""

import pytest

from armland.errors import ModelError
from armland.models.arm_file.formats.text import declared, mesh_file, numbers, read_root, refuse_xacro


@pytest.fixture
def root(tmp_path):
    def read(raw):
        path = tmp_path / "arm.urdf"
        path.write_bytes(raw if isinstance(raw, bytes) else raw.encode())
        return read_root(path, "arm")

    return read


@pytest.mark.parametrize(
    "raw",
    [
        "<robot name='a'/>",
        "\n\n  <?xml version='1.0'?>\n<robot name='a'/>",
        "<?xml version='1.0'?><!-- <x:y/> --><robot name='a'/>",
        "\ufeff<?xml version='1.0' encoding='utf-8'?><robot name='a'/>".encode(),
        "<?xml version='1.0' encoding='utf-16'?><robot name='a'/>".encode("utf-16"),
        "<?xml version='1.0' encoding='latin-1'?><robot name='a'><!-- Gelenk für a --></robot>".encode("latin-1"),
        "<robot name='a'><gz:plugin/><link sensor:type='x' name='l'/></robot>",
        "<robot name='a' xmlns:gz='here'><gz:plugin/><other:thing/></robot>",
    ],
    ids=["bare", "blank lines", "comment", "mark", "utf-16", "latin-1", "unbound", "bound and unbound"],
)
def test_file_is_read_however_it_is_encoded(root, raw):
    assert root(raw).get("name") == "a"


def test_declared_prefixes_are_left_alone():
    text = "<robot xmlns:gz='here'><gz:plugin/></robot>"
    assert declared(text) == text
    assert declared("<robot><gz:plugin/></robot>").startswith('<robot xmlns:gz="undeclared:gz">')


@pytest.mark.parametrize(
    "raw", ["", "<robot>", "<robot name='\xe9'/>".encode("latin-1"), b"\x00\x01", "<a encoding='x'"]
)
def test_what_is_no_xml_is_refused_by_name(root, raw):
    with pytest.raises(ModelError, match="arm is not well-formed XML"):
        root(raw)


@pytest.mark.parametrize(
    ("inner", "found"),
    [
        ("<xacro:include filename='x'/>", "<xacro:include>"),
        ("<link name='${prefix}base'/>", "prefix}base"),
        ("<joint name='j'><origin xyz='0 0 $(arg h)'/></joint>", "arg h"),
    ],
)
def test_xacro_is_refused_with_how_to_expand_it(root, inner, found):
    with pytest.raises(ModelError, match="has not been expanded") as refusal:
        refuse_xacro(root(f"<robot name='a'>{inner}</robot>"), "arm")
    assert found in str(refusal.value)
    assert "xacro FILE.xacro -o arm.urdf" in str(refusal.value)


def test_what_xacro_left_behind_is_no_xacro(root):
    """The namespace on the root, paths of meshes, and parameters of somebody's plug-in; the same in a joint is xacro."""
    head, mesh = "<robot name='a' xmlns:xacro='http://www.ros.org/wiki/xacro'>", "<mesh filename='$(find arm)/l.stl'/>"
    left = f"{head}<link name='l'><visual><geometry>{mesh}</geometry></visual></link><gazebo><p file='$(find arm)'/></gazebo>"
    refuse_xacro(root(f"{left}</robot>"), "arm")
    with pytest.raises(ModelError, match="has not been expanded"):
        refuse_xacro(root(f"{left}<joint name='j'><origin xyz='0 0 $(find arm)'/></joint></robot>"), "arm")


def test_numbers_are_finite_and_as_many_as_wanted():
    assert numbers("1 -2e-1,3", 3, (), "xyz") == (1.0, -0.2, 3.0)
    assert numbers(None, 1, (7.0,), "mass") == numbers("  ", 1, (7.0,), "mass") == (7.0,)
    for text in ("1 2", "one", "nan", "1e999"):
        with pytest.raises(ModelError, match=r"link 'l': mass = .* should be 1 finite number"):
            numbers(text, 1, (), "link 'l': mass")


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("meshes/a.stl", "robots/arm/urdf/meshes/a.stl"),
        ("../meshes/a.stl", "robots/arm/urdf/../meshes/a.stl"),
        ("file://meshes/a.stl", "robots/arm/urdf/meshes/a.stl"),
        ("package://arm/meshes/a.stl", "robots/arm/meshes/a.stl"),
        ("package://other/meshes/a.stl", "robots/arm/meshes/a.stl"),
        ("package://arm/meshes/gone.stl", "robots/arm/urdf/meshes/gone.stl"),
    ],
)
def test_mesh_is_looked_for_beside_its_file_and_upwards(tmp_path, name, at):
    for folder in ("robots/arm/urdf", "robots/arm/meshes"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "robots/arm/meshes/a.stl").write_text("")
    assert mesh_file(name, tmp_path / "robots/arm/urdf/arm.urdf") == str(tmp_path / at)
