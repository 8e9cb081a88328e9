"""What the keys of a device must be together, and the devices with the rest of the podium."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.rules.partial_case import DEVICES, PODIUM, PartialCase
from rpscli.case.schema.devices import DEVICE_KEYS, DeviceSection
from rpscli.case.text.faults import Fault, Path, listed
from rpscli.model.devices import MOST_DEVICES


def devices_rules(case: PartialCase) -> Iterator[Fault]:
    """Each device has the keys of its kind, and there are not too many."""
    written = case.document.at(DEVICES)
    devices = written if isinstance(written, list) else []
    if len(devices) > MOST_DEVICES:
        yield Fault(
            DEVICES,
            f"podium.devices has {len(devices)} devices, at most {MOST_DEVICES} are followed;"
            " write equal ones as one, with the sum of their forces and stiffnesses",
            at_key=True,
        )
    for index, device in enumerate(devices):
        if isinstance(device, dict) and device.get("kind") in DEVICE_KEYS:
            yield from _keys_of(case, (*DEVICES, index), device["kind"])
            yield from _yield_force(case, (*DEVICES, index), device)
    named = [isinstance(device, dict) and device.get("kind") for device in devices]
    tendons = [index for index, kind in enumerate(named) if kind == "tendon"]
    columns = (*PODIUM, "columns")
    if tendons and not case.has(columns):
        yield Fault(
            (*DEVICES, tendons[0]),
            f"podium.devices.{tendons[0]} stands in each column, but podium.columns, their number,"
            " is missing",
            needs=(columns,),
        )


def _keys_of(case: PartialCase, path: Path, kind: str) -> Iterator[Fault]:
    """The keys that a kind needs, and none of another kind."""
    needed, optional = DEVICE_KEYS[kind]
    name = ".".join(map(str, path))
    for key in needed:
        if not case.has((*path, key)):
            meaning = DeviceSection.model_fields[key].description
            text = f"{name}.{key} is missing: {meaning}"
            yield Fault((*path, key), text, at_key=True, needs=((*path, key),))
    for key in case.written(path, *DeviceSection.model_fields):
        if key not in ("kind", *needed, *optional):
            known = listed((*needed, *optional), "and")
            text = f"{name}.{key} is no key of kind: {kind}, which has {known}; take it out"
            yield Fault((*path, key), text, at_key=True)


def _yield_force(case: PartialCase, path: Path, device: dict[str, object]) -> Iterator[Fault]:
    """A tendon carries its prestress."""
    read = case.device(path[-1]) if device["kind"] == "tendon" else None
    if read and read.yield_force and read.prestress and read.yield_force <= read.prestress:
        name = ".".join(map(str, path))
        yield Fault(
            (*path, "yield_force"),
            f"{name}.yield_force = {device['yield_force']} must be > prestress ="
            f" {device['prestress']}{case.where((*path, 'prestress'))}; use a lower prestress, or"
            " leave yield_force out for a tendon that never yields",
        )
