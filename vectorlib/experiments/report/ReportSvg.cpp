#include "vectorlib/experiments/report/Report.h"

#include "vectorlib/io/Svg.h"

namespace hermes::experiments {

using vectorlib::Fixed;
using vectorlib::xmlText;

namespace {

constexpr std::size_t columns = 3;
constexpr double pageWidth = 1240, pageMargin = 30, line = 18, pictureWidth = 380, pictureHeight = 320,
                 caseHead = 600, cellWidth = (pageWidth - 2 * pageMargin) / columns,
                 cellHeight = pictureHeight + 160;

void openPage(std::ostream &out, double height) {
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << Fixed{pageWidth, 0} << "\" height=\""
        << Fixed{height, 0} << "\" viewBox=\"0 0 " << Fixed{pageWidth, 0} << ' ' << Fixed{height, 0}
        << "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n<rect width=\"100%\" "
           "height=\"100%\" "
           "fill=\"#ffffff\"/>\n";
}

void writeTitle(std::ostream &out, double top, const std::string &title) {
    out << "<text x=\"" << pageMargin << "\" y=\"" << Fixed{top + 34, 1}
        << "\" font-size=\"18\" font-weight=\"bold\">" << xmlText(title) << "</text>\n";
}

void writeText(std::ostream &out, double x, double y, const std::string &text, bool bold = false) {
    out << "<text x=\"" << Fixed{x, 1} << "\" y=\"" << Fixed{y, 1} << '"'
        << (bold ? " font-weight=\"bold\"" : "") << '>' << xmlText(text) << "</text>\n";
}

/// Returns where the next line begins.
double writeFacts(std::ostream &out, double x, double y, const std::string &title,
                  const std::vector<Fact> &facts, double indent = 180) {
    if (!title.empty()) {
        writeText(out, x, y, title, true);
        y += line;
    }
    for (const Fact &fact : facts) {
        writeText(out, x, y, fact.name + ":");
        writeText(out, x + indent, y, fact.value);
        y += line;
    }
    return y;
}

/// Facts, and below them and the picture the description.
double writeHead(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                 const CaseReport *report, double y, double pictureEnd) {
    y = writeFacts(out, pageMargin, y + 66, "Dataset", datasetFacts(world.world, settings));
    if (report)
        y = writeFacts(out, pageMargin, y + 10, "Observation", observationFacts(*report));
    y = writeFacts(out, pageMargin, y + 10, "Algorithm settings", settingsFacts(settings));
    y = std::max(y, pictureEnd) + 14;
    writeText(out, pageMargin, y, world.description);
    return y + 30;
}

/// Breaks at spaces; returns where the next line begins.
double writeLines(std::ostream &out, double x, double y, const std::string &text, std::size_t width,
                  bool bold = false) {
    for (std::size_t from = 0; from < text.size();) {
        std::size_t to = text.size();
        if (to - from > width)
            if (to = text.rfind(' ', from + width); to == std::string::npos || to <= from)
                to = from + width;
        writeText(out, x, y, text.substr(from, to - from), bold);
        from = to + (to < text.size() && text[to] == ' ');
        y += line;
    }
    return y;
}

double heightOf(const CaseReport &report) {
    return caseHead +
           cellHeight * static_cast<double>((report.result.solutions.size() + columns - 1) / columns);
}

void writeSolution(std::ostream &out, const CaseReport &report, std::size_t number, double x, double y) {
    drawSolution(report, report.result.solutions[number])
        .writeSvg(out, x, y, pictureWidth - 20, pictureHeight);
    y = writeLines(out, x, y + pictureHeight + 16,
                   "Solution #" + std::to_string(number) + ": " + verdictOf(report, number), 56, true);
    writeFacts(out, x, y, "", solutionFacts(report, number), 80);
    writeFacts(out, x + 190, y, "", countFacts(report.counts[number]), 100);
}

void writeCase(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report, double top) {
    writeTitle(out, top, "Correspondence search, case report: " + world.world.name);
    drawScans(report).writeSvg(out, 480, top + 56, 700, 380);
    double y = writeHead(out, world, settings, &report, top, top + 436);
    writeSvgLegend(out, caseInks(), pageMargin, y);
    writeLines(out, pageMargin, y + 26, searchText(world, report), 200);
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i)
        writeSolution(out, report, i, pageMargin + cellWidth * static_cast<double>(i % columns),
                      top + caseHead + cellHeight * static_cast<double>(i / columns));
}

} // namespace

void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReport &report) {
    writeSvg(out, world, settings, CaseReports{{report}});
}

void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReports &report) {
    double height = 0;
    for (const CaseReport &c : report.cases)
        height += heightOf(c);
    openPage(out, height);
    double top = 0;
    for (const CaseReport &c : report.cases) {
        writeCase(out, world, settings, c, top);
        top += heightOf(c);
    }
    out << "</svg>\n";
}

void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const OverallReport &report) {
    std::size_t rows = 0;
    for (const CaseReport &c : report.cases)
        rows += std::max<std::size_t>(1, static_cast<std::size_t>(std::count_if(
                                             c.result.solutions.begin(), c.result.solutions.end(),
                                             [](const vectorlib::Solution &s) { return s.accepted; })));
    openPage(out, 540 + line * static_cast<double>(rows + 5));
    writeTitle(out, 0, "Correspondence search, overall report: " + world.world.name);
    drawWorld(world.world).writeSvg(out, 480, 56, 720, 400);
    double y = writeHead(out, world, settings, nullptr, 0, 456);
    writeSvgLegend(out, overallInks(), pageMargin, y);
    y += 34;
    const std::vector<double> at = {0, 120, 220, 310, 400, 500, 610, 720, 830};
    const auto writeRow = [&](const std::vector<std::string> &cells, bool bold = false) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            writeText(out, pageMargin + at[i], y, cells[i], bold);
        y += line;
    };
    writeRow({"Scan points", "Solution", "Rel.", "Amb. cm2", "Disc. cm2", "True pos.", "True neg.",
              "False pos.", "False neg."},
             true);
    forEachAccepted(report, [&](const std::vector<std::string> &cells) { writeRow(cells); });
    writeLines(out, pageMargin, y + 10, summaryOf(world, report), 170, true);
    out << "</svg>\n";
}

} // namespace hermes::experiments
