"""The file of a chain with correct stiffnesses."""

import re
from pathlib import Path
from xml.etree import ElementTree

from verify.engines.reading import Solid
from verify.errors import InputError, shown
from verify.files import whole


def write_corrected(path: Path, kind: str, solids: list[Solid], new: dict[str, float], out: Path) -> str:
    """The file with stiffnesses `new` by joint and nothing else changed; returns a sentence. Raises InputError."""
    edits, data = list[tuple[int, int, str]](), path.read_bytes()
    text = re.sub(rb"(?s)<!--.*?-->", lambda comment: b" " * len(comment[0]), data)
    if kind != "mujoco":
        for name, k in new.items():
            joint = name.removesuffix(" axis2")  # the second of a universal joint
            within = rf"(?:(?!</joint>).)*?<axis{'2' * (joint != name)}\b" if kind == "sdf" else ""
            tag, field, spring = ("joint", "name", "spring_s") if kind == "sdf" else ("gazebo", "reference", "springS")
            head = rf"(?s)<{tag}\s[^>]*{field}\s*=\s*[\"']{re.escape(joint)}[\"']{within}"
            spot = re.search(rf"{head}(?:(?!</{tag}>).)*?<{spring}tiffness>([^<]*)".encode(), text)
            edits += [(*spot.span(1), repr(k))] if spot else []
    else:
        tags = [
            tag
            for tag in re.finditer(rb"(?s)<(?:free)?joint\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*", text)
            if text.rfind(b"<worldbody", 0, tag.start()) > text.rfind(b"</worldbody", 0, tag.start())
        ]
        compiled = {move.joint: move.stiffness for one in solids for move in one.moves}
        bodies = [[one.tag for one in body] for body in ElementTree.fromstring(data).iter("body")]
        behind = any("joint" in names[names.index("body") :] for names in bodies if "body" in names)
        alike = len(tags) == len(compiled) and not behind and b"springdamper" not in text  # it overrides stiffness
        for found, (joint, present) in zip(tags, compiled.items(), strict=False):
            named, own = (
                re.search(rb"\s" + word + rb"\s*=\s*[\"']\s*([^\"'\s]*)", found[0]) for word in (b"name", b"stiffness")
            )
            alike &= not named or named[1].decode() == joint
            alike &= not own or abs(float(own[1]) - present) <= 1e-9 * abs(present)
            place = (found.start() + own.start(1), found.start() + own.end(1)) if own else (found.start() + 6,) * 2
            if joint in new:
                edits.append((*place, repr(new[joint]) if own else f' stiffness="{new[joint]!r}"'))
        if not alike:
            raise InputError(f"{path.name}: its joints are not in its text in order, write it by mj_saveLastXML first")
    for start, end, word in sorted(edits, reverse=True):
        data = data[:start] + word.encode() + data[end:]
    with whole(out, "corrected") as part:
        part.write_bytes(data)
    return f"wrote {shown(str(out))}: other stiffnesses, nothing else"
