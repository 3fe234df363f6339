#!/usr/bin/env python3
"""Fails when an include crosses a wall: who may include whom stands in docs/architecture.md.

Checks itself first: made-up includes that cross each wall must be caught."""
import os
import re
import sys

# What a folder may include of ours, by the first (for daemons: first two) parts of the path.
ALLOWED = {
    "vectorlib": {"vectorlib"},
    "protocol": {"protocol"},
    "common": {"common", "protocol"},
    "daemons/motorcontrol": {"common", "protocol"},
    "daemons/velodynelogger": {"common", "protocol"},
    "daemons/seriallogger": {"common", "protocol"},
    "daemons/softwaretrigger": {"common", "protocol"},
    "daemons/supervisor": {"common", "protocol"},
    "daemons/scanmatcher": {"common", "protocol", "vectorlib"},
    "daemons/simulator": {"common", "protocol", "vectorlib"},
    "gui": {"common", "protocol", "vectorlib"},
}
# Rooms of vectorlib that everyone may include: one result type, one pose, one twist, one pi in the whole project.
OF_ALL = ("vectorlib/error", "vectorlib/geometry")
# Qt that a folder may include; None means any.
QT_ALLOWED = {"vectorlib": set(), "protocol": {"QByteArray", "QCborStreamReader", "QCborStreamWriter", "QString", "QStringList", "QVector", "QVariant", "QtGlobal", "QtEndian",
                                               "QJsonObject", "QJsonArray", "QJsonValue", "QJsonDocument", "QMap"}}
# The rooms of vectorlib, from the ground up: each may include those before it.
ROOMS = ("error", "geometry", "simd", "tls", "segmentation", "vectorization", "edges", "observation", "registration", "similarity",
         "correspondence", "motion", "places", "mapping", "relations", "graph", "io")
OURS = ("vectorlib", "protocol", "common", "daemons", "gui")
# The namespace of each program's code; what is shared is in hermes.
NAMESPACES = {**{folder: "hermes::" + folder.split("/")[1] for folder in ALLOWED if folder.startswith("daemons/")},
              "gui/desktop": "hermes::desktop", "gui/hermesctl": "hermes::ctl", "gui/vector": "hermes::vector"}
NAMESPACE = re.compile(r"^namespace (hermes[\w:]*) \{")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def zone_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "daemons" and len(parts) > 2 else parts[0]


def room_of(path):
    """The room of vectorlib that a header lies in, or None."""
    parts = path.split("/")
    return parts[1] if parts[0] == "vectorlib" and len(parts) == 3 else None


def complaint(path, include, root):
    """Why the file may not include this, or None."""
    zone = zone_of(path)
    allowed = ALLOWED.get(zone)
    if allowed is None:
        return f"folder {zone} has no entry in {os.path.basename(__file__)}"
    if include.startswith("."):
        return "includes are written from the project's root, never relative with dots"
    name = include.split("/")[-1]
    if re.match(r"Q[A-Z]|Qt", name) and zone in QT_ALLOWED and name not in QT_ALLOWED[zone]:
        return f"{zone} may include only these of Qt: {', '.join(sorted(QT_ALLOWED[zone])) or 'nothing'}"
    if path.startswith("vectorlib/include/") and include == "vectorlib/vectorlib.h":
        return "the rooms of vectorlib include what they need, not all"
    room, target_room = room_of(path.removeprefix("vectorlib/include/")), room_of(include)
    for name in (room, target_room):
        if name and name not in ROOMS:
            return f"vectorlib/{name} has no place among the rooms of {os.path.basename(__file__)}"
    if room and target_room and ROOMS.index(target_room) > ROOMS.index(room):
        return f"vectorlib/{room} is below vectorlib/{target_room}"
    first = include.split("/")[0]
    if first not in OURS:
        beside = os.path.join(root, os.path.dirname(path), include)
        return "files of ours are included by their path from the root" if os.path.exists(beside) else None
    target = zone_of(include)
    if target == zone or first in allowed or include.startswith(tuple(room + "/" for room in OF_ALL)):
        return None
    return f"{zone} may include only {', '.join(sorted(allowed))} (and itself)"


def namespace_complaint(path, namespace):
    """Why the file may not open this namespace, or None."""
    own = NAMESPACES.get("/".join(path.split("/")[:2]))
    # Fields of a struct of the protocol are looked for in hermes.
    fine = own is None or (namespace + "::").startswith(own + "::") or (namespace == "hermes" and path.endswith("Messages.cpp"))
    return None if fine else f"{os.path.dirname(path)} has the namespace {own}"


def self_test():
    crossing = [("vectorlib/include/vectorlib/io/Csv.h", "QString"), ("vectorlib/include/vectorlib/io/Csv.h", "QtCore/QFile"),
                ("vectorlib/include/vectorlib/io/Csv.h", "common/Result.h"), ("protocol/jsonrpc/A.cpp", "QTcpSocket"),
                ("protocol/jsonrpc/A.cpp", "common/Result.h"), ("common/daemon/A.cpp", "vectorlib/mapping/MapBuilder.h"),
                ("daemons/scanmatcher/A.cpp", "daemons/simulator/B.h"), ("gui/hermesctl/A.cpp", "daemons/simulator/B.h"),
                ("vectorlib/include/vectorlib/edges/A.h", "vectorlib/mapping/MapBuilder.h"),
                ("daemons/velodynelogger/A.cpp", "vectorlib/mapping/MapBuilder.h"), ("common/A.cpp", "daemons/simulator/B.h")]
    fine = [("vectorlib/include/vectorlib/io/A.h", "vectorlib/edges/MapEdge.h"), ("daemons/scanmatcher/A.cpp", "vectorlib/mapping/MapBuilder.h"), ("daemons/scanmatcher/A.cpp", "daemons/scanmatcher/B.h"),
            ("protocol/jsonrpc/A.cpp", "QJsonObject"), ("common/A.cpp", "protocol/jsonrpc/JsonRpc.h"), ("gui/A.cpp", "vector")]
    wrong = [f"not caught: {p} including {i}" for p, i in crossing if not complaint(p, i, "/nonexistent")]
    if not namespace_complaint("daemons/supervisor/A.h", "hermes") or namespace_complaint("gui/vector/A.h", "hermes::vector") \
            or not namespace_complaint("gui/vector/A.h", "hermes::vectors"):
        wrong.append("namespaces are judged wrongly")
    return wrong + [f"wrongly refused: {p} including {i}" for p, i in fine if complaint(p, i, "/nonexistent")]


def main():
    root = os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(__file__), "..", "..")
    errors = self_test()
    count = 0
    for top in OURS:
        for folder, _, files in os.walk(os.path.join(root, top)):
            for name in sorted(files):
                if not name.endswith((".h", ".hpp", ".cpp")):
                    continue
                path = os.path.relpath(os.path.join(folder, name), root)
                with open(os.path.join(root, path), encoding="utf-8") as source:
                    for number, line in enumerate(source, 1):
                        opened = NAMESPACE.match(line)
                        if opened and (why := namespace_complaint(path, opened.group(1))):
                            errors.append(f"{path}:{number}: {line.strip()}: {why}")
                        match = INCLUDE.match(line)
                        if match:
                            count += 1
                            why = complaint(path, match.group(2), root)
                            if why:
                                errors.append(f"{path}:{number}: {line.strip()}: {why}")
    print("\n".join(errors) or f"{count} includes, no wall crossed")
    return 1 if errors or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
