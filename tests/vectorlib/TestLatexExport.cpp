#include "tests/support/Latex.h"

#include <vectorlib/io/LatexExport.h>

using namespace vectorlib;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <typename Write>
static QByteArray document(Write write, LatexExport::As as = LatexExport::As::Document) {
    std::ostringstream out;
    LatexExport latex(out, "A title", as);
    write(latex);
    latex.finish();
    return QByteArray::fromStdString(out.str());
}

static Picture room() {
    Picture picture("Room 50 % & #1");
    picture.area({"#b7d9c0", 0, "common area"}, {{0, 0}, {4, 0}, {4, 3}});
    picture.segments<double>({colour::map, 2, "walls", false, true}, {{{0, 0}, {4, 0}}, {{4, 0}, {4, 3}}});
    picture.clusters<float>(3, {{{1, 1}, {2, 1}}, {{3, 2}}});
    picture.path({colour::estimate, 1, "path", true}, {{1, 1}, {2, 2}, {3, 1}});
    picture.pose({colour::reference, 2, "sensor"}, {1, 1}, 0);
    return picture;
}

/// LaTeXExport of thesis 4.2.2.
class TestLatexExport : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void textIsEscaped_data() {
        const Rows<QByteArray, QByteArray> row("text", "latex");
        row("plain", "a b-c", "a b-c");
        row("meaning", "%_\\{}#$&", "\\%\\_\\textbackslash{}\\{\\}\\#\\$\\&");
        row("command", "\\input{/etc/passwd}", "\\textbackslash{}input\\{/etc/passwd\\}");
        row("exponent", "m^2 s^-1", "m\\ensuremath{^{2}} s\\ensuremath{^{-1}}");
        row("no exponent", "^a^~", "\\^{}a\\^{}\\~{}");
        row("dashes", "--svg", "-{}-svg");
        row("option of a line's end", "[2pt]", "{[}2pt{]}");
        row("star of a line's end", "*2", "{*}2");
        row("controls", "a\n\tb\x7f", "a  b ");
        row("letters", "Ko\u0161ice \u00e9", "Ko\u0161ice \u00e9");
        row("signs", "90\u00b0 \u00b1 \u03c3",
            "90\\ensuremath{^\\circ} \\ensuremath{\\pm} \\ensuremath{\\sigma}");
        row("without a sign", "\u4e2d", "{[}U+4E2D{]}");
        row("no UTF-8", "a\xff\xc3", "a??");
        row("overlong", "\xc0\xaf", "??");
        row("surrogate", "\xed\xa0\x80", "???");
    }
    void textIsEscaped() {
        QFETCH(QByteArray, text);
        QTEST(QByteArray::fromStdString(latexText(text.toStdString())), "latex");
    }

    void everyLayerIsDrawn() {
        const QByteArray text = document([](LatexExport &latex) { latex.picture(room()); });
        QVERIFY(text.startsWith("\\documentclass") && text.endsWith("\\end{document}\n"));
        for (const char *part :
             {"\\section*{A title}", "\\subsection*{Room 50 \\% \\& \\#1}", "{x [m]}", "{y [m]}", "dashed",
              "circle (1.8pt)", "--cycle;", "~common area}", "~walls}", "~path}", "~cluster 0: 2 points}",
              "~sensor}", "{rgb,255:red,27;green,42;blue,65}"})
            QVERIFY2(text.contains(part), part);
        QCOMPARE(text.count("\\begin{tikzpicture}"), 1);
        QCOMPARE(text.count('{'), text.count('}') + text.count("\\{") - text.count("\\}"));
    }
    /// A wall from (0, 0) to (4, 0): free space above it. 4.4 m are 14 cm.
    void normalsPointToFreeSpace() {
        Picture picture("");
        picture.segments<double>({colour::map, 2, "", false, true}, {{{0, 0}, {4, 0}}});
        const QByteArray text = document([&](LatexExport &latex) { latex.picture(picture); });
        QVERIFY2(text.contains("--+(0.000,0.150);"), text.constData());
    }
    void fragmentNamesItsPackages() {
        const QByteArray text =
            document([](LatexExport &latex) { latex.picture(room()); }, LatexExport::As::Fragment);
        QVERIFY(text.startsWith("% For \\input"));
        QVERIFY(text.contains("% \\usepackage{tikz}"));
        for (const char *part : {"\\documentclass", "\\begin{document}", "\\end{document}", "section*"})
            QVERIFY2(!text.contains(part), part);
    }

    void tableIsFilledUp() {
        const Table table{"T_1", {"a", "b"}, {{"1"}, {"1", "2", "$x$"}}};
        const QByteArray text = document([&](LatexExport &latex) { latex.table(table); });
        QVERIFY2(text.contains("{T\\_1}") && text.contains("{lrr}") && text.contains("a & b &  \\\\") &&
                     text.contains("1 &  &  \\\\") && text.contains("1 & 2 & $x$ \\\\"),
                 text.constData());
    }
    void longTablesGoOn() {
        const Table table{"", {"a"}, std::vector<std::vector<std::string>>(60, {"1"})};
        const QByteArray text = document([&](LatexExport &latex) { latex.table(table); });
        QVERIFY(text.contains("\\begin{longtable}") && text.contains("\\endhead"));
    }

    /// Nothing, NaN and numbers beyond every place: no number that TeX cannot read, and an end.
    void nothingAndNonsense() {
        for (const QByteArray &text : nonsense()) {
            QVERIFY2(!text.contains("inf") && text.endsWith("\\end{document}\n"), text.constData());
            QVERIFY2(!text.contains("nan"), text.constData());
            QVERIFY(text.size() < 20000);
        }
    }
    void largeScansAreCutIntoCommands() {
        Picture picture("");
        std::vector<Vector2D<double>> points;
        for (int i = 0; i < 20000; ++i)
            points.emplace_back(std::cos(i * 0.001), std::sin(i * 0.001));
        picture.points({colour::points, 1, ""}, points);
        picture.path({colour::points, 1, ""}, points);
        for (const QByteArray &line :
             document([&](LatexExport &latex) { latex.picture(picture); }).split('\n'))
            QVERIFY(line.size() < 300);
    }

    void documentsCompile() {
        const hermes::Latex latex;
        if (!latex.missing().isEmpty())
            QSKIP(latex.missing().constData());
        QTemporaryDir folder;
        QByteArray all = document([](LatexExport &l) {
            l.picture(room());
            l.table({"wide", std::vector<std::string>(12, "a column"), {}});
            l.text("%_\\{}#$&^~<>|\"'`-- \u0161\u00e9\u00b0\u03c3\u4e2d\xff [a] ?` << \n\n");
            l.table(
                {"T_1", {"a", "b"}, std::vector<std::vector<std::string>>(60, {"1", latexText("[2pt]")})});
        });
        const QByteArray begin = "\\begin{document}\n", end = "\\end{document}\n";
        all.chop(end.size());
        for (QByteArray text : nonsense())
            all += text.mid(text.indexOf(begin) + begin.size()).replace(end, "\n\n");
        const QString name = folder.filePath("all.tex");
        put(name, all + end);
        const QByteArray fault = hermes::Latex::fault(name);
        QVERIFY2(fault.isEmpty(), fault.constData());
    }

private:
    static std::vector<QByteArray> nonsense() {
        std::vector<QByteArray> texts;
        const auto add = [&](auto write) { texts.push_back(document(write)); };
        add([](LatexExport &) {});
        add([](LatexExport &latex) { latex.picture(Picture("")); });
        for (const double value :
             {none, std::numeric_limits<double>::infinity(), 1e300, -1e300, 1e17, 1e-300}) {
            Picture picture("p");
            picture.points<double>({"#12", 1, "p"}, {{value, 0}, {value, value}});
            picture.segments<double>({"", 1, "s", false, true}, {{{0, value}, {0, value}}});
            picture.area({"red", 1, "a"}, {{value, 1}});
            picture.path({"#zzzzzz", 1, "t"}, {{value, 1}});
            picture.pose({colour::map, 1, "o"}, {value, 0}, value);
            add([&](LatexExport &latex) { latex.picture(picture); });
        }
        add([](LatexExport &latex) {
            latex.table({});
            latex.text("");
        });
        return texts;
    }
};
