"""Cases, studies and records that were damaged: each is read, or refused in plain words."""

import os
from pathlib import Path

import pytest
from small_records import cosmos, csmip, esm, geonet, knet, smc

from hunt.trials import hunt, hunted, judged, mutated, shares
from rpscli.case.build import DEVICE_KEYS as NEEDED
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import known_paths
from rpscli.case.study.schema import StudyFile
from rpscli.records.formats.at2 import at2_text
from rpscli.records.loading import load_record

pytestmark = pytest.mark.posix  # trials are timed by its signals

CASES = Path(__file__).parents[2] / "cases"
CASE_TEXTS = [
    path.read_text(encoding="utf-8").replace("records/", f"{CASES}/records/")
    for path in sorted(CASES.glob("*.yaml"))
]
STUDY_TEXTS = [
    path.read_text(encoding="utf-8").replace("../", f"{CASES}/")
    for path in sorted((CASES / "studies").glob("*.yaml"))
]
CASE_KEYS = [".".join(map(str, path)) for path in known_paths(CaseFile)]
STUDY_KEYS = [".".join(map(str, path)) for path in known_paths(StudyFile)]
KINDS = (
    "viscous",
    "friction",
    "stop",
    "tendon",
    "rolling_resistance",
    "{a: 1}",
    "[viscous]",
    "5",
)
DEVICE_KEYS = (
    "kind", "coefficient", "exponent", "force", "stiffness", "gap", "restitution", "prestress",
    "area", "yield_force", "lever", "damping", "\\e[31m",
)  # fmt: skip
"""Below `podium.devices`, right and wrong."""
VALUES = [
    "0", "1", "-1", "1e-300", "1e300", ".nan", ".inf", "x", "[]", "{}", "[1, 2]", "[[1]]", "{a: 1}",
    "true", "2 t", "3 mm", "4 kN/mm", "critical", "auto", "1000000000", "'2 parsec'", "[x, 1]",
    "200", "{low: 0, high: 1, count: 1000000000}", "{low: 1, high: 2, count: 3}", "0,3",
    "'~nouser/x'", "pulse:sine?amplitude=1e300g&period=1", "[null]", "'" + "x" * 300 + "'",
]  # fmt: skip
"""For any key."""

COLUMN = "# units: g, dt: 0.01\n" + "\n".join(
    f"{0.01 * (i % 7 - 3):.4f}" for i in range(60)
)
COLUMNS = "Time (s)  Acceleration (m/s2)\n" + "\n".join(
    f"{0.02 * i:.2f}  {0.3 * (i % 5 - 2):.4f}" for i in range(60)
)


def written(name, text, random):
    """Write a text in some encoding; what can be read of it again."""
    encoding = random.choice(["utf-8", "utf-8", "utf-8", "latin-1", "utf-16"])
    data = text.encode(encoding, "replace")
    if random.random() < 0.05:
        data = bytes(random.randrange(256) for _ in range(random.randrange(300))) + data
    Path(name).write_bytes(data)
    return data.decode(encoding, "replace")


@hunted("cases", 60, 8000)
def test_cases(random):
    text = mutated(random.choice(CASE_TEXTS), random)
    text += written("case.yaml", text, random)
    command = random.choice(["check", "check", "check", "modal"])
    options = (
        random.choice([(), ("--json",), ("-q",)]) if command == "check" else ("--json",)
    )
    return judged(command, "case.yaml", *options, places=("case.yaml",), text=text)


@hunted("values of cases", 60, 5000)
def test_values_of_cases(random):
    text = random.choice(CASE_TEXTS)
    Path("case.yaml").write_text(text, encoding="utf-8")
    changes = [
        f"{random.choice(CASE_KEYS)}={random.choice(VALUES)}"
        for _ in range(random.choice([1, 1, 2, 3]))
    ]
    options = [word for change in changes for word in ("--set", change)]
    places = ("case.yaml", "--set")
    text = " ".join([text, *changes])
    return judged("check", "case.yaml", *options, "--json", places=places, text=text)


@hunted("devices", 40, 3000)
def test_devices(random):
    Path("case.yaml").write_text(random.choice(CASE_TEXTS), encoding="utf-8")
    devices = []
    for _ in range(random.choice([1, 1, 2])):
        kind, values = random.choice(KINDS), [*VALUES, *["0.5", "0.1 m", "20 kN/mm"] * 8]
        keys = set(random.sample(DEVICE_KEYS, random.choice([0, 0, 1, 3])))
        keys |= {*NEEDED.get(kind, ((), ()))[0]}  # else hardly one is accepted
        inside = "".join(f", {key}: {random.choice(values)}" for key in sorted(keys))
        devices.append(f"{{kind: {kind}{inside}}}")
    change = f"podium.devices=[{', '.join(devices)}]"
    places = ("case.yaml", "--set")
    return judged("check", "case.yaml", "--set", change, "--json", places=places)


@shares
def test_contact(long):
    """Compliant ends: each kind with sizes, right and wrong, below other laws and devices."""
    sizes = {"period_ratio": ("1.2", "1.01"), "stiffness": ("60 MN/m", "9 kN/mm"),
             "settlement": ("0.05 mm", "5 mm"), "damping": ("0", "0.1")}  # fmt: skip
    soft = (
        (CASES / "measured_period.yaml").read_text(encoding="utf-8").split("record:")[0]
    )

    def trial(random):
        text = random.choice([soft, soft, soft, *CASE_TEXTS])
        Path("case.yaml").write_text(text, encoding="utf-8")
        kind = random.choice([*["plane", "edges"] * len(VALUES), "rigid", *VALUES])
        keys = random.sample([*sizes], random.choice([0, 1, 1, 1, 2, 3]))
        inside = "".join(
            f", {key}: {random.choice([*VALUES, *sizes[key] * len(VALUES)])}"
            for key in keys
        )
        changes = [f"podium.contact={{kind: {kind}{inside}}}"]
        if random.random() < 0.3:
            changes.append(random.choice([f"podium.impact.law={random.choice(LAWS)}",
                                          "analysis.recontact_tolerance=1e-8"]))  # fmt: skip
        options = [word for change in changes for word in ("--set", change)]
        command = random.choice(["check", "check", "modal", "pushover"])
        places = ("case.yaml", "--set")
        return judged(command, "case.yaml", *options, "--json", places=places)

    hunt("contact", trial, 30, 2000 if long else None)


LAWS = ("flexible", "rigid", "value", "x")
NAMES = ["..", "a", "#", "?b=c", " ", "\x1b", "\n", "\u202e", "\udce4", ",", "'", "="]
NAMES += ["&factor=2", "x:"]


@hunted("names", 40, 1000)
def test_names(random):
    folder = Path(f"f{random.randrange(10**9)}")
    folder.mkdir()
    name = "".join(random.choice(NAMES) for _ in range(random.randrange(1, 4))) + ".at2"
    (folder / name).write_text(at2())
    Path("case.yaml").write_text(CASE_TEXTS[0], encoding="utf-8")
    source = random.choice([f"{folder}/{name}", str(folder), f"{folder}/*"])
    return judged("record", "info", source, "--json", places=(str(folder),))


@hunted("studies", 12, 1200)
def test_studies(random):
    written("study.yaml", mutated(random.choice(STUDY_TEXTS), random), random)
    return judged("sweep", "study.yaml", "--dry-run", places=("study.yaml", ".yaml:"))


@hunted("values of studies", 12, 500)
def test_values_of_studies(random):
    Path("study.yaml").write_text(random.choice(STUDY_TEXTS), encoding="utf-8")
    change = f"{random.choice([*STUDY_KEYS, *CASE_KEYS])}={random.choice(VALUES)}"
    return judged("sweep", "study.yaml", "--dry-run", "--set", change)


def at2():
    return at2_text(load_record("synthetic:?pga=0.3g&seed=1&duration=2&dt=0.02"))


LAYOUTS = {
    "rec.AT2": at2,
    "rec.v1": cosmos,
    "rec.V2": csmip,
    "rec.V2A": geonet,
    "rec.NS": knet,
    "rec.ASC": esm,
    "rec.smc": smc,
    "rec.txt": lambda: COLUMN,
    "rec.csv": lambda: COLUMNS,
}
OPTIONS = [
    "",
    "",
    "",
    "?dt=0.01",
    "?units=g",
    "?dt=0.01&units=g",
    "?channel=1",
    "?channel=2",
]
OPTIONS += [
    "?dt=1E999",
    "?dt=",
    "?units=" + "g" * 999,
    "?channel=" + "7" * 5000,
    "?step=1",
]


def judged_record(name, text, random):
    written(name, text, random)
    source = name + random.choice(OPTIONS)
    return judged("record", "info", source, "--json", places=(name,))


@shares
@pytest.mark.parametrize("name", LAYOUTS)
def test_records(name, long):
    text = LAYOUTS[name]()

    def trial(random):
        return judged_record(name, mutated(text, random), random)

    hunt(f"records {name}", trial, 20, 700 if long else None)


@shares
def test_records_of_the_agencies(long, records_folder):
    files = [
        path
        for path in sorted((records_folder / "formats").iterdir())
        if path.suffix != ".md"
    ]
    texts = {path.name: path.read_text(encoding="latin-1") for path in files}

    def trial(random):
        name = random.choice(sorted(texts))
        return judged_record(name, mutated(texts[name], random), random)

    hunt("records of agencies", trial, 4, 700 if long else None)


@hunted("folders of records", 6, 300)
def test_folders_of_records(random):
    """Of a study: what is no record is left out, and none hangs."""
    folder = Path(f"folder{random.random()}")
    folder.mkdir()
    for name in random.sample(sorted(LAYOUTS), 3):
        written(f"{folder}/{name}", mutated(LAYOUTS[name](), random), random)
    text = f"rps: 1\nbase: {CASES}/rigid_frame.yaml\nrecords: [{folder}]\n"
    Path("study.yaml").write_text(text, encoding="utf-8")
    return judged("sweep", "study.yaml", "--dry-run", places=("study.yaml", str(folder)))


PATHS = [
    "x" * 5000, "~nouser/x", "", " ", "/dev/zero", "/dev/null", "/", ".", "..",
    "case.yaml/x", "-x", "fifo", "C:/x", "nowhere/x.yaml", "*", "[", "?", "\udce4", "建物.yaml", "http://x/y",
    "loop",
]  # fmt: skip


@shares
def test_paths(long, monkeypatch):
    monkeypatch.setattr("rpscli.case.text.files._PATIENCE", 0.01)
    Path("case.yaml").write_text(CASE_TEXTS[0], encoding="utf-8")
    os.mkfifo("fifo")
    Path("loop").symlink_to("loop")

    def trial(random):
        path = random.choice(PATHS)
        Path("study.yaml").write_text("rps: 1\nbase: case.yaml\n", encoding="utf-8")
        Path("other.yaml").write_text(
            f"rps: 1\nbase: {path!r}\n", encoding="utf-8", errors="replace"
        )
        commands = [
            ("check", "--", path),
            ("record", "info", "--", path),
            ("check", "case.yaml", "--set", f"record.source={path!r}"),
            ("sweep", "other.yaml", "--dry-run"),
            ("sweep", "study.yaml", "--dry-run", "--set", f"records=[{path!r}]"),
        ]
        return judged(*random.choice(commands))

    hunt("paths", trial, 25, 300 if long else None)
