#include "gui/vector/report/Report.h"

namespace hermes::vector {

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

void openDocument(std::ostream &out) {
    out << "\\documentclass[a4paper,10pt]{article}\n\\usepackage[T1]{fontenc}\n\\usepackage[utf8]{inputenc}\n"
           "\\usepackage[margin=2cm]{geometry}\n\\usepackage{longtable}\n\\usepackage{tikz}\n"
           "\\setlength{\\parindent}{0pt}\n\\setlength{\\emergencystretch}{3em}\n";
    defineColours(out, allInks());
    out << "\\begin{document}\n";
}

void writeTitle(std::ostream &out, const ReportWorld &world, const char *kind) {
    out << "\\section*{Correspondence search}\n\\subsection*{" << kind << " report -- "
        << latexText(world.world.name) << " dataset}\n";
}

void writeFacts(std::ostream &out, const std::string &title, const std::vector<Fact> &facts) {
    if (!title.empty())
        out << "\\textbf{" << title << ":}\\\\[2pt]\n";
    out << "\\begin{tabular}{@{}ll@{}}\n";
    for (const Fact &fact : facts)
        out << mathText(fact.name) << ": & " << mathText(fact.value) << "\\\\\n";
    out << "\\end{tabular}\n";
}

/// Facts to the left, a picture to the right, description and legend below.
void writeHead(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport *report, const Drawing &picture, const std::vector<const Ink *> &inks) {
    out << "\\begin{minipage}[t]{0.44\\textwidth}\\vspace{0pt}\n";
    writeFacts(out, "Dataset", datasetFacts(world.world, settings));
    if (report) {
        out << "\\par\\bigskip\n";
        writeFacts(out, "Observation", observationFacts(*report));
    }
    out << "\\par\\bigskip\n";
    writeFacts(out, "Algorithm settings", settingsFacts(settings));
    out << "\\end{minipage}\\hfill\n\\begin{minipage}[t]{0.54\\textwidth}\\vspace{0pt}\\raggedleft\n";
    picture.writeTikz(out, 9, 9);
    out << "\n\\end{minipage}\n\\par\\bigskip\n\\textbf{Description:}\\\\[2pt]\n"
        << latexText(world.description) << "\n\\par\\bigskip\n\\textbf{Legend:}\\\\[2pt]\n{\\raggedright\n";
    writeTikzLegend(out, inks);
    out << "\\par}\\bigskip\n";
}

void writeSolution(std::ostream &out, const CaseReport &report, std::size_t number) {
    out << "\\begin{minipage}{\\textwidth}\n\\begin{minipage}[c]{0.55\\textwidth}\n";
    drawSolution(report, report.result.solutions[number]).writeTikz(out, 9, 6.5);
    out << "\n\\end{minipage}\\hfill\n\\begin{minipage}[c]{0.42\\textwidth}\\raggedright\n";
    writeFacts(out, "Solution \\#" + std::to_string(number), solutionFacts(report, number));
    out << "\\\\[2pt]$\\Rightarrow$ \\textbf{" << latexText(verdictOf(report, number)) << "}\\par\\medskip\n";
    writeFacts(out, "Statistics", countFacts(report.counts[number]));
    out << "\\end{minipage}\n\\end{minipage}\\par\\bigskip\n";
}

void writeCase(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report) {
    writeTitle(out, world, "Case");
    writeHead(out, world, settings, &report, drawScans(report), caseInks());
    out << "\\textbf{Solutions:}\\quad " << latexText(searchText(world, report)) << "\\par\\bigskip\n";
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i)
        writeSolution(out, report, i);
}

} // namespace

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReport &report) {
    writeLatex(out, world, settings, CaseReports{{report}});
}

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReports &report) {
    openDocument(out);
    for (std::size_t i = 0; i < report.cases.size(); ++i) {
        out << (i ? "\\clearpage\n" : "");
        writeCase(out, world, settings, report.cases[i]);
    }
    out << "\\end{document}\n";
}

void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const OverallReport &report) {
    openDocument(out);
    writeTitle(out, world, "Overall");
    writeHead(out, world, settings, nullptr, drawWorld(world.world), overallInks());
    out << "\\textbf{Accepted results:}\n\\begin{longtable}{lcrrrrrrr}\n\\hline\n"
           "Scan & Solution & Rel. & Amb. & Disc. & True & True & False & False\\\\\n"
           "points & number & & cm$^2$ & cm$^2$ & positive & negative & positive & negative\\\\\n\\hline\n"
           "\\endhead\n";
    forEachAccepted(report, [&](const std::vector<std::string> &cells) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            out << (i ? " & " : "") << mathText(cells[i]);
        out << "\\\\\n";
    });
    out << "\\hline\n\\end{longtable}\n" << latexText(summaryOf(world, report)) << "\n\\end{document}\n";
}

} // namespace hermes::vector
