import re
from xml.etree import ElementTree

import pytest

from manual.formulas import block, indexed


def test_formula_is_mathml_with_its_number_beside_it() -> None:
    html = block("\\dot V_2 = -k_3\\, z_1^\\top Q z_1 \\tag{30}\n")
    assert re.findall(r'<span class="number">(.*?)</span>', html) == ["(30)"]
    formula = ElementTree.fromstring(re.search(r"<math.*</math>", html)[0])
    assert "".join(formula.itertext()).replace(" ", "") == "V˙2=−k3z1⊤Qz1"


def test_script_letters_are_characters() -> None:
    assert "𝒥" in block("\\bar{\\mathcal J} = M^{-1} \\mathcal J^\\top")


def test_lines_are_aligned_where_the_source_says() -> None:
    html = block("\\begin{aligned}\na &= b \\\\\n&= c\n\\end{aligned}\n")
    assert html.count("<mtr>") == 2
    assert "&" not in re.sub(r"&#\w+;", "", html)


@pytest.mark.parametrize(
    ("html", "shown"),
    [
        ("the error q_e is", "the error q<sub>e</sub> is"),
        ("R_eᵀω_d, ṙ_d.", "R<sub>e</sub>ᵀω<sub>d</sub>, ṙ<sub>d</sub>."),
        ("Δτ_att and F_EE", "Δτ<sub>att</sub> and F<sub>EE</sub>"),
        ("k_θ|η_e|", "k<sub>θ</sub>|η<sub>e</sub>|"),
        ("hand_over, own_law, x_", "hand_over, own_law, x_"),
        ('<a href="a_b">r_d</a> <code>q_e</code>', '<a href="a_b">r<sub>d</sub></a> <code>q_e</code>'),
        ("<pre><span>q_e</span></pre><br/>q_e", "<pre><span>q_e</span></pre><br/>q<sub>e</sub>"),
    ],
)
def test_index_stands_below_the_line_in_running_text(html: str, shown: str) -> None:
    assert indexed(html) == shown
