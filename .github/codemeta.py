#!/usr/bin/env python3
"""codemeta.json from CITATION.cff, the one to be edited: .github/codemeta.py [--check]."""

import json
import sys
from pathlib import Path

import yaml

HERE = Path(__file__).parent
CITATION = HERE.parent / "CITATION.cff"
PLACE = HERE / "codemeta.json"


def author(of: dict[str, str]) -> dict[str, str]:
    """A person with names, or a group with one."""
    if "name" in of:
        return {"@type": "Organization", "name": of["name"]}
    names = {"givenName": of["given-names"], "familyName": of["family-names"]}
    return {"@type": "Person", **({"@id": of["orcid"]} if "orcid" in of else {}), **names}


def codemeta(citation: dict) -> str:
    """The document of a citation."""
    source = citation["repository-code"]
    document = {
        "@context": "https://doi.org/10.5063/schema/codemeta-2.0",
        "@type": "SoftwareSourceCode",
        "name": citation["title"],
        "description": citation["abstract"].strip(),
        "version": str(citation["version"]),
        "license": f"https://spdx.org/licenses/{citation['license']}",
        "codeRepository": source,
        "issueTracker": f"{source}/issues",
        "programmingLanguage": "Python",
        "keywords": citation["keywords"],
        "author": [author(each) for each in citation["authors"]],
    }
    if "date-released" in citation:
        document["datePublished"] = str(citation["date-released"])
    if "doi" in citation:
        document["identifier"] = f"https://doi.org/{citation['doi']}"
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


def main() -> None:
    """Write it, or say that it is not what the citation says."""
    made = codemeta(yaml.safe_load(CITATION.read_text("utf-8")))
    if sys.argv[1:] == ["--check"]:
        if PLACE.read_text("utf-8") != made:
            raise SystemExit(
                "codemeta.json is not that of CITATION.cff: .github/codemeta.py"
            )
        return
    PLACE.write_text(made, "utf-8")


if __name__ == "__main__":
    main()
