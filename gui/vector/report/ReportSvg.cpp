#include "gui/vector/report/Report.h"

#include "vectorlib/io/Svg.h"

namespace hermes::vector {

using vectorlib::Fixed;
using vectorlib::xmlText;

namespace {

constexpr double pageWidth = 1240, pageMargin = 30, line = 18, pictureWidth = 380, pictureHeight = 320;

void openPage(std::ostream &out, double height, const std::string &title) {
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << Fixed{pageWidth, 0} << "\" height=\""
        << Fixed{height, 0} << "\" viewBox=\"0 0 " << Fixed{pageWidth, 0} << ' ' << Fixed{height, 0}
        << "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n<rect width=\"100%\" "
           "height=\"100%\" "
           "fill=\"#ffffff\"/>\n<text x=\""
        << pageMargin << "\" y=\"34\" font-size=\"18\" font-weight=\"bold\">" << xmlText(title)
        << "</text>\n";
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
                 const CaseReport *report, double pictureEnd) {
    double y = writeFacts(out, pageMargin, 66, "Dataset", datasetFacts(world.world, settings));
    if (report)
        y = writeFacts(out, pageMargin, y + 10, "Observation", observationFacts(*report));
    y = writeFacts(out, pageMargin, y + 10, "Algorithm settings", settingsFacts(settings));
    y = std::max(y, pictureEnd) + 14;
    writeText(out, pageMargin, y, world.description);
    return y + 30;
}

} // namespace

void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReport &report) {
    constexpr int columns = 3;
    constexpr double head = 520, cell = pictureHeight + 140, width = (pageWidth - 2 * pageMargin) / columns;
    const std::size_t rows = (report.result.solutions.size() + columns - 1) / columns;
    openPage(out, head + 40 + cell * static_cast<double>(rows),
             "Correspondence search, case report: " + world.world.name);
    drawScans(report).writeSvg(out, 480, 56, 700, 380);
    const double y = writeHead(out, world, settings, &report, 436);
    writeSvgLegend(out, caseInks(), pageMargin, y);
    writeText(out, pageMargin, y + 26,
              "Search: " + std::to_string(report.result.potentialPairs) + " potential pairs, " +
                  std::to_string(report.result.bundles) + " bundles in " +
                  std::to_string(report.result.buckets) + " buckets, " +
                  std::to_string(report.result.combinations) + " bundles tried; " +
                  describe(report.result.outcome) + ".");
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i) {
        const vectorlib::Solution &solution = report.result.solutions[i];
        const double x = pageMargin + width * static_cast<double>(i % columns);
        const double top = head + 40 + cell * static_cast<double>(i / columns);
        drawSolution(report, solution).writeSvg(out, x, top, pictureWidth - 20, pictureHeight);
        const double below = top + pictureHeight + 16;
        writeText(out, x, below,
                  "Solution #" + std::to_string(i) + (solution.accepted ? ": accepted" : ": rejected"), true);
        writeFacts(out, x, below + line, "", solutionFacts(solution), 80);
        writeFacts(out, x + 190, below + line, "", countFacts(report.counts[i]), 100);
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
    openPage(out, 540 + line * static_cast<double>(rows + 3),
             "Correspondence search, overall report: " + world.world.name);
    drawWorld(world.world).writeSvg(out, 480, 56, 720, 400);
    double y = writeHead(out, world, settings, nullptr, 456);
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
    writeText(out, pageMargin, y + 10, summaryOf(report), true);
    out << "</svg>\n";
}

} // namespace hermes::vector
