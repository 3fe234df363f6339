#!/usr/bin/env python3
"""Usage: library_reference.py INCLUDE FOLDER
Makes the reference of vectorlib: of each folder of INCLUDE/vectorlib one page of markdown in FOLDER, and FOLDER.md, which lists
all. The text is that of the comments (///) of the headers, which doxygen reads. A class, an enumeration, a call operator or a member of a
namespace without a comment is an error; so is what doxygen warns about."""
import collections
import html
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

AREAS = {  # the folders, from scans to maps
    "geometry": "Points, segments, lines, poses and transformations in the plane.",
    "error": "A value or an error: what functions return that can fail.",
    "segmentation": "Cuts a scan into clusters of neighbouring points.",
    "vectorization": "Turns a cluster of points into line segments.",
    "tls": "Total least squares lines from sums over points, and how sure they are.",
    "edges": "Segments with the sums of their points: the edges of scans and maps.",
    "motion": "Odometry, and scans that are straightened by the motion of the sensor.",
    "observation": "What a sensor sees from a pose in a map of segments, and how that differs from a scan.",
    "similarity": "How much two sets of segments agree.",
    "correspondence": "Which segment of a scan is which segment of the map.",
    "registration": "The pose at which pairs of segments, or points and segments, agree best.",
    "relations": "Matches two scans without an expected pose, by the relations between their segments.",
    "places": "Finds the place of a scan in a map without an expected pose.",
    "mapping": "Builds, aligns, reviews and searches vector maps.",
    "graph": "Closes loops: a graph of poses, and the drive that it corrects.",
    "io": "Reads and writes scans, segments, maps, pictures and plots.",
    "simd": "The few functions that have versions for AVX2 and NEON.",
}
SETTINGS = {"RECURSIVE": "YES", "FILE_PATTERNS": "*.h", "GENERATE_HTML": "NO", "GENERATE_LATEX": "NO", "GENERATE_XML": "YES",
            "XML_PROGRAMLISTING": "NO", "QUIET": "YES", "WARN_IF_UNDOCUMENTED": "NO", "WARN_AS_ERROR": "FAIL_ON_WARNINGS",
            "AUTOLINK_SUPPORT": "NO", "MACRO_EXPANSION": "YES", "EXPAND_ONLY_PREDEF": "YES", "PREDEFINED": "VECTORLIB_INLINE=inline"}
KINDS = {"function", "variable", "typedef", "enum", "friend"}
TAGS = {"para": "p", "computeroutput": "code", "orderedlist": "ol", "itemizedlist": "ul", "listitem": "li"}


def run_doxygen(include, folder):
    """The compounds of all headers, as elements of doxygen's XML."""
    settings = {**SETTINGS, "INPUT": include, "STRIP_FROM_PATH": include, "OUTPUT_DIRECTORY": folder}
    text = "".join(f'{name} = "{value}"\n' for name, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text, text=True, check=True)
    for entry in ElementTree.parse(os.path.join(folder, "xml", "index.xml")).getroot():
        if entry.get("kind") in ("class", "struct", "union", "namespace"):
            yield ElementTree.parse(os.path.join(folder, "xml", entry.get("refid") + ".xml")).getroot()[0]


def code_of(element):
    """Code as the headers write it; doxygen puts blanks into brackets."""
    text = " ".join("".join(element.itertext()).split()) if element is not None else ""
    return re.sub(r"(?<=<) | (?=>)", "", text).replace("vectorlib::", "")


def name_of(element):
    """The name of a class, or of a member of a namespace, as one who uses the library writes it."""
    name = element.find("compoundname")
    return code_of(name if name is not None else element.find("qualifiedname"))


def line_of(element):
    return int(element.find("location").get("line"))


def anchor(name):
    return re.sub(r"\W+", "-", name).strip("-")


def template_of(element):
    """The line that begins a template; empty for what is none."""
    parameters = element.find("templateparamlist")
    if parameters is None:
        return ""
    texts = [f"{code_of(p.find('type'))} {p.findtext('declname') or ''}".strip() +
             (f" = {code_of(p.find('defval'))}" if p.find("defval") is not None else "") for p in parameters]
    return f"template <{', '.join(texts)}>"


class Reference:
    """All classes and members of namespaces by header, and the pages made of them."""

    def __init__(self, compounds):
        self.headers = collections.defaultdict(list)  # path -> classes and members of namespaces
        self.places = {}  # name of a class or enumeration -> page and anchor
        for compound in compounds:
            elements = compound.iter("memberdef") if compound.get("kind") == "namespace" else [compound]
            for element in elements:
                if element.get("prot") == "public":
                    self.headers[element.find("location").get("file")].append(element)
        for path, elements in self.headers.items():
            elements.sort(key=line_of)
            for element in elements:
                if element.tag == "compounddef" or element.get("kind") == "enum":
                    name = name_of(element)
                    place = anchor(name) if element.tag == "compounddef" else os.path.basename(path)
                    self.places.setdefault(re.sub("<.*", "", name), f"{self.area(path)}.html#{place}")

    @staticmethod
    def area(path):
        return path.split("/")[1]

    def undocumented(self):
        """What has no comment but must have one, as texts."""
        for path, elements in sorted(self.headers.items()):
            inner = [m for e in elements if e.tag == "compounddef" for m in e.iter("memberdef")
                     if m.get("prot") == "public" and (m.get("kind") == "enum" or m.findtext("name") == "operator()")]
            for element in sorted(elements + inner, key=line_of):
                if not self.comment(element) and not all(map(self.comment, element.findall("enumvalue") or [element])):
                    yield f"{path}:{line_of(element)}: {name_of(element)} has no comment"

    def linked(self, code):
        """Code as HTML, where the name of a class leads to it."""
        def link(match):
            place = self.places.get(match[0])
            return f'<a href="{place}">{match[0]}</a>' if place else html.escape(match[0])
        return re.sub(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*|.", link, code)

    def words(self, text):
        """Prose as HTML, where a name in CamelCase leads to its class; a plain word such as Match does not."""
        return re.sub(r"\w+|\W+", lambda m: self.linked(m[0]) if re.search("[a-z][A-Z]|2D", m[0]) else html.escape(m[0]), text or "")

    def prose(self, element):
        """An element of a comment, and the text behind it, as HTML."""
        if element.tag == "ndash":
            return "--" + self.words(element.tail)
        if element.tag not in TAGS:
            sys.exit(f"library_reference.py: a comment has what this program does not know: <{element.tag}>")
        if element.tag == "computeroutput":
            inner = self.linked("".join(element.itertext()))
        else:
            inner = self.words(element.text) + "".join(map(self.prose, element))
        return f"<{TAGS[element.tag]}>{inner.strip()}</{TAGS[element.tag]}>{self.words(element.tail)}"

    def comment(self, element):
        parts = [part for name in ("briefdescription", "detaileddescription") for part in element.find(name)]
        return "".join(map(self.prose, parts)).replace("\n", " ").strip()

    def declaration(self, member, name):
        """A member as it is declared, as HTML."""
        kind, template = member.get("kind"), template_of(member)
        if kind == "enum":
            code = ("enum class " if member.get("strong") == "yes" else "enum ") + name
        elif kind == "typedef":
            code = f"using {name} = {code_of(member.find('type'))}"
        else:
            arguments = re.sub(r"(?<![<>=!])=(?!=)", " = ", code_of(member.find("argsstring")))
            value = " " + code_of(member.find("initializer")) if kind == "variable" else ""
            code = f"{'static ' * (member.get('static') == 'yes')}{code_of(member.find('type'))} "
            code = re.sub(r"(?<=[*&]) $", "", code).lstrip() + name + arguments + value
        return (self.linked(template) + "<br>" if template else "") + self.linked(code.strip())

    def table(self, members):
        """A table of members in HTML; variables of one statement share a row."""
        rows = []  # [statement, declarations, comment]
        for member in sorted(members, key=line_of):
            if member.get("prot") != "public" or member.get("kind") not in KINDS:
                continue
            name = member.findtext("name") if member.get("id").startswith(("class", "struct", "union")) else name_of(member)
            statement = (line_of(member), code_of(member.find("type")), member.get("kind"))
            if rows and rows[-1][0] == statement:
                rows[-1][1].append(self.declaration(member, name))
                rows[-1][2] = rows[-1][2] or self.comment(member)
            else:
                rows.append([statement, [self.declaration(member, name)], self.comment(member)])
            rows += [[None, [f"&emsp;{value.findtext('name')}"], self.comment(value)] for value in member.findall("enumvalue")]
        lines = [f"<tr><td><code>{'<br>'.join(declarations)}</code></td><td>{comment}</td></tr>" for _, declarations, comment in rows]
        return ['<div class="api"><table>', *lines, "</table></div>", ""] if lines else []

    def paths(self, area):
        return sorted(path for path in self.headers if self.area(path) == area)

    def page(self, area):
        """The text of a page."""
        lines = [f"# vectorlib/{area}", "", AREAS[area], ""]
        for path in self.paths(area):
            header = os.path.basename(path)
            lines += [f"## {header} {{#{header}}}", "", f"`#include <{path}>`", "",
                      *self.table(e for e in self.headers[path] if e.tag == "memberdef")]
            for element in (e for e in self.headers[path] if e.tag == "compounddef"):
                name, template = name_of(element), template_of(element)
                bases = ", ".join(map(code_of, element.findall("basecompoundref")))
                head = (html.escape(template) + "<br>" if template else "") + html.escape(f"{element.get('kind')} {name}")
                lines += [f"### {html.escape(name)} {{#{anchor(name)}}}", "",
                          f"<p><code>{head}{' : ' + self.linked(bases) if bases else ''}</code></p>", "",
                          self.comment(element), "", *self.table(element.iter("memberdef"))]
        return "\n".join(lines)

    def index(self, folder):
        """The text of the page of all classes and functions."""
        lines = ["# vectorlib", "", "The classes and functions of the library. `#include <vectorlib/vectorlib.h>` gives those that scan "
                 "processing needs. What exists only with AVX2 or NEON is left out.", ""]
        for area, text in AREAS.items():
            links = {}
            for path in self.paths(area):
                for element in self.headers[path]:
                    name = name_of(element)
                    if element.tag == "compounddef" and "::" not in name:
                        links[name] = anchor(name)
                    elif element.get("kind") == "function" and "operator" not in name and "::" not in name:
                        links[name + "()"] = os.path.basename(path)
            lines += [f"## [vectorlib/{area}]({folder}/{area}.md)", "", text, "",
                      ", ".join(f"[{html.escape(name)}]({folder}/{area}.md#{place})" for name, place in links.items()), ""]
        return "\n".join(lines)


def main():
    include, folder = sys.argv[1:]
    with tempfile.TemporaryDirectory() as work:
        reference = Reference(run_doxygen(include, work))
    wrong = [f"{path}: its folder is not in library_reference.py" for path in reference.headers if reference.area(path) not in AREAS]
    wrong += reference.undocumented()
    if wrong:
        sys.exit("\n".join(wrong))
    os.makedirs(folder)
    for name, text in [(folder, reference.index(os.path.basename(folder)))] + [(os.path.join(folder, a), reference.page(a)) for a in AREAS]:
        with open(name + ".md", "w", encoding="utf-8") as file:
            file.write(text + "\n")


if __name__ == "__main__":
    main()
