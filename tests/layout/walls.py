#!/usr/bin/env python3
"""Fails when an include crosses a wall: who may include whom stands in docs/architecture.md.

Checks itself first: made-up includes that cross each wall must be caught."""
import os
import re
import sys

# What a folder may include of ours, by the first (for daemons and experiments: first two) parts of the path. The experiments are for
# nobody else.
ALLOWED = {
    "vectorlib": {"vectorlib"},
    "vectorlib/experiments": {"common", "protocol", "vectorlib", "gui/vector"},
    "protocol": {"protocol"},
    "common": {"common", "protocol"},
    "daemons/motorcontrol": {"common", "protocol"},
    "daemons/velodynelogger": {"common", "protocol"},
    "daemons/recorder": {"common", "protocol"},
    "daemons/ros2": {"common", "protocol"},
    "daemons/seriallogger": {"common", "protocol"},
    "daemons/scanner": {"common", "protocol"},
    "daemons/softwaretrigger": {"common", "protocol"},
    "daemons/supervisor": {"common", "protocol"},
    "daemons/web": {"common", "protocol"},
    "daemons/scanmatcher": {"common", "protocol", "vectorlib"},
    "daemons/simulator": {"common", "protocol", "vectorlib"},
    "gui": {"common", "protocol", "vectorlib"},
}
# Rooms of vectorlib that everyone may include: one result type, one pose, one twist, one pi in the whole project.
OF_ALL = ("vectorlib/error", "vectorlib/geometry")
# Qt that a folder may include; None means any.
QT_ALLOWED = {"vectorlib": set(), "vectorlib/experiments": set(), "protocol": {"QByteArray", "QCborStreamReader", "QCborStreamWriter", "QString", "QStringList", "QVector", "QVariant", "QtGlobal", "QtEndian",
                                               "QJsonObject", "QJsonArray", "QJsonValue", "QJsonDocument", "QMap"}}
# The rooms of vectorlib, from the ground up: each may include those before it.
ROOMS = ("error", "geometry", "simd", "tls", "segmentation", "vectorization", "edges", "observation", "registration", "similarity",
         "correspondence", "motion", "places", "mapping", "relations", "graph", "io")
OURS = ("vectorlib", "protocol", "common", "daemons", "gui")
# The namespace of each program's code; what is shared is in hermes.
NAMESPACES = {**{folder: "hermes::" + folder.split("/")[1] for folder in ALLOWED if folder.startswith("daemons/")},
              "gui/desktop": "hermes::desktop", "gui/hermesctl": "hermes::ctl", "gui/vector": "hermes::vector",
              "vectorlib/experiments": "hermes::experiments"}
NAMESPACE = re.compile(r"^namespace (hermes[\w:]*) \{")
# What is built for Windows, too (docs/windows.md), and knows nothing of a system but in sources whose names end with its name, which
# stand beside each other: XPosix.cpp and XWindows.cpp for X.h. Of common these are the sources that its CMakeLists.txt names before
# `if(NOT WIN32)`, and their headers.
PORTABLE = ("vectorlib", "protocol", "gui")
OF_SYSTEM = re.compile(r"(Posix|Windows)\.cpp$")
POSIX = re.compile(r"(unistd|fcntl|termios|poll|pwd|grp|signal|netdb|dirent|dlfcn|sched|pthread|execinfo|spawn|glob|fnmatch|syslog|ifaddrs|"
                   r"getopt|libgen|wordexp|strings|semaphore|mqueue|ftw|sysexits|ucontext|utime|langinfo|iconv|regex|cpio|tar|aio|nl_types)\.h$|"
                   r"(sys|arpa|net|netinet|linux|asm|bits)/")
WINDOWS = re.compile(r"(windows|winsock2|ws2tcpip|io|shellapi|shlobj|conio|process|direct)\.h$|QWinEventNotifier$")
# Names of files are UTF-8, which Windows takes only where it is told: std::filesystem::u8path(text) and path.u8string().
CODE_PAGE = re.compile(r"\b(filesystem|fs)::path\(\w|\.string\(\)")
# By processor and system, within one header.
OF_SYSTEM_TOO = ("vectorlib/include/vectorlib/simd/Simd.h", "common/platform/WindowsError.h")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def zone_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if (parts[0] == "daemons" or path.startswith("vectorlib/experiments/")) and len(parts) > 2 else parts[0]


def room_of(path):
    """The room of vectorlib that a header lies in, or None."""
    parts = path.split("/")
    return parts[1] if parts[0] == "vectorlib" and len(parts) == 3 and parts[1] != "experiments" else None


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
    room, target_room = room_of(re.sub("^vectorlib/(include/vectorlib|src)/", "vectorlib/", path)), room_of(include)
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
    permitted = tuple(folder + "/" for folder in (*allowed, *OF_ALL))
    if target == zone or (include.startswith(permitted) and target != "vectorlib/experiments"):
        return None
    return f"{zone} may include only {', '.join(sorted(allowed))} (and itself)"


def system_complaint(path, include):
    """Why a file that is built for Windows, too, may not include this, or None."""
    system = OF_SYSTEM.search(path)
    if path in OF_SYSTEM_TOO or not (POSIX.match(include) or WINDOWS.match(include)):
        return None
    wanted = "Posix" if POSIX.match(include) else "Windows"
    if system and (system.group(1) == wanted or include == "fcntl.h"):
        return None
    return f"this is built for all systems; what one of them has stands in a source X{wanted}.cpp beside X.h"


def portable_sources(lists):
    """Paths of the sources of common that are built for Windows, too; lists: folder and text of each CMakeLists.txt."""
    found = set()
    for folder, text in lists:
        for name in re.findall(r"[\w/${}]+\.cpp", text.split("if(NOT WIN32)")[0]):
            for system in ("Posix", "Windows"):
                found.add(os.path.normpath(f"{folder}/{name.replace('${HERMES_SYSTEM}', system).replace('${name}', '')}"))
        for names in re.findall(r"foreach\(name ([\w ]+)\)", text):
            found.update(f"{folder}/{name}{system}.cpp" for name in names.split() for system in ("Posix", "Windows"))
    return found


def portable_headers(sources, includes):
    """Headers of common that those sources and gui/ reach; and complaints where such a header belongs to a source that is not built for
    Windows. includes: of each path, with the number of the line."""
    errors, reached = [], set()
    waiting = [p for p in includes if p.startswith(PORTABLE) or p in sources]
    while waiting:
        path = waiting.pop()
        if path.endswith("Posix.cpp"):
            continue # it may use what only POSIX has
        for number, include in includes[path]:
            if not include.startswith("common/") or include not in includes or include in reached:
                continue
            stem = include.removesuffix(".h")
            own = [p for p in (stem + ".cpp", stem + "Posix.cpp") if p in includes]
            if own and not any(p in sources for p in own):
                errors.append(f"{path}:{number}: {include}: its source is not built for Windows, and this file is")
                continue
            reached.add(include)
            waiting.append(include)
    return reached, errors


def system_errors(root, includes):
    """Complaints about what is built for Windows, too."""
    lists = []
    for folder, _, files in os.walk(os.path.join(root, "common")):
        if "CMakeLists.txt" in files:
            with open(os.path.join(folder, "CMakeLists.txt"), encoding="utf-8") as text:
                lists.append((os.path.relpath(folder, root), text.read()))
    sources = {p for p in portable_sources(lists) if p in includes}
    headers, errors = portable_headers(sources, includes)
    for path in sorted(includes):
        if path.startswith(PORTABLE) or path in sources or path in headers:
            errors += [f"{path}:{number}: {include}: {why}" for number, include in includes[path] if (why := system_complaint(path, include))]
        if system := OF_SYSTEM.search(path):
            stem = path[:system.start()]
            missing = [stem + end for end in ("Posix.cpp", "Windows.cpp", ".h") if stem + end not in includes]
            if missing:
                errors.append(f"{path}: beside it is no {', '.join(missing)}")
    return errors if sources else ["no source of common is built for Windows"]


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
                ("vectorlib/src/edges/A.cpp", "vectorlib/mapping/MapBuilder.h"),
                ("daemons/velodynelogger/A.cpp", "vectorlib/mapping/MapBuilder.h"), ("common/A.cpp", "daemons/simulator/B.h"),
                ("gui/vector/A.cpp", "vectorlib/experiments/B.h"), ("vectorlib/include/vectorlib/io/A.h", "vectorlib/experiments/B.h"),
                ("vectorlib/experiments/A.cpp", "gui/desktop/B.h"), ("vectorlib/experiments/A.cpp", "QString")]
    fine = [("vectorlib/include/vectorlib/io/A.h", "vectorlib/edges/EdgeRaw2D.h"), ("daemons/scanmatcher/A.cpp", "vectorlib/mapping/MapBuilder.h"), ("daemons/scanmatcher/A.cpp", "daemons/scanmatcher/B.h"),
            ("protocol/jsonrpc/A.cpp", "QJsonObject"), ("common/A.cpp", "protocol/jsonrpc/JsonRpc.h"), ("gui/A.cpp", "vector"),
            ("vectorlib/experiments/A.cpp", "gui/vector/Input.h"), ("vectorlib/experiments/A.cpp", "vectorlib/io/Svg.h")]
    wrong = [f"not caught: {p} including {i}" for p, i in crossing if not complaint(p, i, "/nonexistent")]
    if not namespace_complaint("daemons/supervisor/A.h", "hermes") or namespace_complaint("gui/vector/A.h", "hermes::vector") \
            or not namespace_complaint("gui/vector/A.h", "hermes::vectors"):
        wrong.append("namespaces are judged wrongly")
    if not system_complaint("gui/A.cpp", "unistd.h") or not system_complaint("gui/APosix.cpp", "windows.h") or \
            not system_complaint("gui/A.h", "sys/socket.h") or system_complaint("gui/APosix.cpp", "sys/socket.h") or \
            system_complaint("gui/A.cpp", "QSocketNotifier") or system_complaint("gui/AWindows.cpp", "windows.h"):
        wrong.append("headers of systems are judged wrongly")
    if not CODE_PAGE.search("fs::path(name)") or not CODE_PAGE.search("a.filename().string()") or CODE_PAGE.search("fs::u8path(a).u8string()"):
        wrong.append("names of files are judged wrongly")
    sources = portable_sources([("common", "STATIC A.cpp b/C${HERMES_SYSTEM}.cpp)\nif(NOT WIN32)\n D.cpp"), ("common/p", "foreach(name E F)")])
    if sources != {"common/A.cpp", "common/b/CPosix.cpp", "common/b/CWindows.cpp", "common/p/EPosix.cpp", "common/p/EWindows.cpp",
                   "common/p/FPosix.cpp", "common/p/FWindows.cpp"}:
        wrong.append(f"sources that are built for Windows are found wrongly: {sources}")
    tree = {"gui/A.cpp": [(1, "common/A.h")], "common/A.h": [(1, "common/D.h")], "common/A.cpp": [], "common/D.h": [], "common/D.cpp": []}
    if portable_headers({"common/A.cpp"}, tree) != ({"common/A.h"}, ["common/A.h:1: common/D.h: its source is not built for Windows, and this file is"]):
        wrong.append("headers that are built for Windows are found wrongly")
    return wrong + [f"wrongly refused: {p} including {i}" for p, i in fine if complaint(p, i, "/nonexistent")]


def main():
    root = os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(__file__), "..", "..")
    errors = self_test()
    count = 0
    includes = {}
    for top in OURS:
        for folder, _, files in os.walk(os.path.join(root, top)):
            for name in sorted(files):
                if not name.endswith((".h", ".hpp", ".cpp")):
                    continue
                path = os.path.relpath(os.path.join(folder, name), root)
                includes[path] = []
                with open(os.path.join(root, path), encoding="utf-8") as source:
                    for number, line in enumerate(source, 1):
                        opened = NAMESPACE.match(line)
                        if opened and (why := namespace_complaint(path, opened.group(1))):
                            errors.append(f"{path}:{number}: {line.strip()}: {why}")
                        if path.startswith(("gui/vector/", "vectorlib/experiments/", "common/capture/", "common/platform/", "common/world/")) and CODE_PAGE.search(line):
                            errors.append(f"{path}:{number}: {line.strip()}: names of files are UTF-8: u8path(), u8string()")
                        match = INCLUDE.match(line)
                        if match:
                            count += 1
                            includes[path].append((number, match.group(2)))
                            why = complaint(path, match.group(2), root)
                            if why:
                                errors.append(f"{path}:{number}: {line.strip()}: {why}")
    errors += system_errors(root, includes)
    print("\n".join(errors) or f"{count} includes, no wall crossed")
    return 1 if errors or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
