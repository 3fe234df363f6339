#include "vectorlib/experiments/report/Report.h"
#include "vectorlib/io/LatexExport.h"

namespace hermes::experiments {

using vectorlib::LatexExport;
using vectorlib::latexText;

namespace {

/// Names and units as LaTeX: symbols for dx, dy, dalpha, squares.
std::string mathText(const std::string &text) {
    std::string result = latexText(text);
    const auto replace = [&](const std::string &from, const std::string &to) {
        for (std::size_t at = result.find(from); at != std::string::npos;
             at = result.find(from, at + to.size()))
            result.replace(at, from.size(), to);
    };
    replace("|dalpha|", "$|\\Delta\\alpha|$");
    replace("|dx|", "$|\\Delta x|$");
    replace("|dy|", "$|\\Delta y|$");
    replace("dalpha", "$\\Delta\\alpha$");
    replace("True dx", "True $\\Delta x$");
    replace("True dy", "True $\\Delta y$");
    replace("k alpha", "$k_\\alpha$");
    replace("k xy", "$k_{xy}$");
    replace("cm2", "cm$^2$");
    replace("rad2", "rad$^2$");
    replace(" x 50", " $\\times$ 50");
    replace(" to \\#", " $\\Rightarrow$ \\#");
    replace("sigma", "$\\sigma$");
    return result;
}

void writeTitle(LatexExport &document, const ReportWorld &world, const std::string &kind) {
    document.latex("\\section*{Correspondence search}\n\\subsection*{" + kind + " report -- " +
                   latexText(world.world.name) + " dataset}\n");
}

void writeFacts(LatexExport &document, const std::string &title, const std::vector<Fact> &facts) {
    if (!title.empty())
        document.latex("\\textbf{" + latexText(title) + ":}\\\\[2pt]\n");
    document.latex("\\begin{tabular}{@{}ll@{}}\n");
    for (const Fact &fact : facts)
        document.latex(mathText(fact.name) + ": & " + mathText(fact.value) + "\\\\\n");
    document.latex("\\end{tabular}\n\\par\\bigskip\n");
}

/// Facts to the left, a picture to the right, description and legend below.
void writeHead(LatexExport &document, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport *report, const Drawing &drawing, const std::vector<const Ink *> &inks) {
    document.beside(
        0.44,
        [&] {
            writeFacts(document, "Dataset", datasetFacts(world.world, settings));
            if (report)
                writeFacts(document, "Observation", observationFacts(*report));
            writeFacts(document, "Algorithm settings", settingsFacts(settings));
        },
        [&] {
            document.drawing(drawing.picture(), {7.7, 9, Drawing::gridStep});
        });
    document.latex("\\textbf{Description:}\\\\[2pt]\n");
    document.text(world.description);
    document.latex("\\bigskip\n\\textbf{Legend:}\\\\[2pt]\n");
    document.legend(layersOf(inks));
}

void writeSolution(LatexExport &document, const CaseReport &report, std::size_t number) {
    document.beside(
        0.57,
        [&] {
            document.drawing(drawSolution(report, report.result.solutions[number]).picture(),
                             {8, 6.5, Drawing::gridStep});
        },
        [&] {
            writeFacts(document, "Solution #" + std::to_string(number), solutionFacts(report, number));
            document.latex("$\\Rightarrow$ \\textbf{" + latexText(verdictOf(report, number)) +
                           "}\\par\\medskip\n");
            writeFacts(document, "Statistics", countFacts(report.counts[number]));
        });
}

void writeCase(LatexExport &document, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report) {
    writeTitle(document, world, "Case");
    writeHead(document, world, settings, &report, drawScans(report), caseInks());
    document.latex("\\textbf{Solutions:}\\quad\n");
    document.text(searchText(world, report));
    document.latex("\\bigskip\n");
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i)
        writeSolution(document, report, i);
}

} // namespace

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReport &report) {
    writeLatex(out, world, settings, CaseReports{{report}});
}

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReports &report) {
    LatexExport document(out);
    for (std::size_t i = 0; i < report.cases.size(); ++i) {
        document.latex(i ? "\\clearpage\n" : "");
        writeCase(document, world, settings, report.cases[i]);
    }
    document.finish();
}

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const OverallReport &report) {
    LatexExport document(out);
    writeTitle(document, world, "Overall");
    writeHead(document, world, settings, nullptr, drawWorld(world.world), overallInks());
    const auto two = [](const char *above, const char *below) {
        return std::string("\\shortstack[r]{") + above + "\\\\" + below + '}';
    };
    vectorlib::Table table{"Accepted results",
                           {"Scan points", "Solution", "Rel.", two("Amb.", "cm$^2$"), two("Disc.", "cm$^2$"),
                            two("True", "positive"), two("True", "negative"), two("False", "positive"),
                            two("False", "negative")},
                           {}};
    forEachAccepted(report, [&](const std::vector<std::string> &cells) {
        table.rows.emplace_back();
        std::transform(cells.begin(), cells.end(), std::back_inserter(table.rows.back()), mathText);
    });
    document.table(table);
    document.text(summaryOf(world, report));
    document.finish();
}

} // namespace hermes::experiments
