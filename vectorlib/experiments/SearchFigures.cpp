#include "vectorlib/experiments/SearchFigures.h"

#include "vectorlib/correspondence/PublishedSearch.h"
#include "vectorlib/experiments/SearchStages.h"
#include "vectorlib/experiments/report/Report.h"
#include "vectorlib/io/LatexExport.h"
#include "vectorlib/io/Svg.h"

#include <sstream>

namespace hermes::experiments {

namespace {

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;
using vectorlib::Fixed;
using vectorlib::Transformation2D;

const Ink oldScan{Ink::Kind::Lines, "oldscan", "#8d99ae", 2.6, "Static scan"};
const Ink newScan{Ink::Kind::Lines, "newscan", "#111111", 1.4, "Dynamic scan, as expected"};
const Ink cloud{Ink::Kind::Dots, "newcloud", "#009e73", 2.0, "Points of the dynamic scan"};
const Ink pairLink{Ink::Kind::Lines, "potentialpair", "#d62828", 0.8, "Potential pair"};
const Ink sensor{Ink::Kind::Pose, "sensor", "#0072b2", 1.4, "Sensor"};
const Ink firstField{Ink::Kind::Area, "firstfield", "#dfe5ee", 0, "Seen from the first pose"};
const Ink secondField{Ink::Kind::Area, "secondfield", "#b7d9c0", 0, "Seen from the second as well"};
const Ink staticSet{Ink::Kind::Lines, "staticset", "#111111", 1.6, "Static set"};
const Ink expectedPart{Ink::Kind::Lines, "expectedview", "#009e73", 3.0, "Expected view"};
const Ink border{Ink::Kind::Lines, "frontier", "#8d99ae", 1.0, "Border of what was explored", true};

std::string decimals(double value, int count) {
    std::ostringstream out;
    out << Fixed{value, count};
    return out.str();
}

// The search with the scans of a figure.
struct Example {
    CaseReport report;
    vectorlib::PublishedSearch search;

    explicit Example(std::uint64_t seed) {
        report.scans = searchScene(searchExample(), seed, searchExampleScans()).pairs.at(0);
    }
    const vectorlib::PublishedResult &within(double accuracy) {
        search.settings.permitted = {accuracy, accuracy, accuracy * 1.05};
        return search(report.scans.fixed.segments, report.scans.moving.segments);
    }
    Drawing scans() const {
        Drawing drawing;
        drawing.segments(oldScan, report.scans.fixed.segments);
        drawing.segments(newScan, report.scans.moving.segments);
        return drawing;
    }
    Segment linkOf(const vectorlib::PotentialPair &pair) const {
        return {report.scans.moving.segments[static_cast<std::size_t>(pair.numbers.moving)].middle(),
                report.scans.fixed.segments[static_cast<std::size_t>(pair.numbers.fixed)].middle()};
    }
};

void addScans(std::vector<SearchFigure> &figures, const Example &example) {
    std::vector<Point> thinned;
    const std::vector<vectorlib::Vector2D<float>> &points = example.report.scans.moving.points;
    for (std::size_t i = 0; i < points.size(); i += 5)
        thinned.emplace_back(points[i]);
    Drawing drawing;
    drawing.segments(oldScan, example.report.scans.fixed.segments);
    drawing.segments(newScan, example.report.scans.moving.segments);
    drawing.dots(cloud, thinned);
    drawing.pose(sensor, {});
    figures.push_back({"scans",
                       "Figure 7.16: two vectorized scans to be registered",
                       drawing,
                       {oldScan, newScan, cloud, sensor}});
}

void addPotentialPairs(std::vector<SearchFigure> &figures, Example &example) {
    for (const double accuracy : {0.3, 0.7, 1.2}) {
        example.within(accuracy);
        Drawing drawing = example.scans();
        for (const vectorlib::PotentialPair &pair : example.search.pairs())
            drawing.segment(pairLink, example.linkOf(pair));
        drawing.pose(sensor, {});
        figures.push_back({"pairs-" + decimals(100 * accuracy, 0) + "cm",
                           "Figure 7.17: " + std::to_string(example.search.pairs().size()) +
                               " potential pairs within " + decimals(accuracy, 2) + " m and " +
                               decimals(1.05 * accuracy, 2) + " rad",
                           drawing,
                           {oldScan, newScan, pairLink, sensor}});
    }
}

void addBuckets(std::vector<SearchFigure> &figures, Example &example) {
    const vectorlib::PublishedResult &found = example.within(1.2);
    const vectorlib::PublishedBundles &sorted = example.search.bundles();
    for (std::size_t bucket = 0; bucket < sorted.buckets().size(); ++bucket) {
        Drawing drawing = example.scans();
        std::vector<Ink> inks = {oldScan, newScan};
        for (const std::size_t number : sorted.buckets()[bucket]) {
            const vectorlib::PublishedBundle &bundle = sorted.bundles()[number];
            const std::size_t i = inks.size() - 2;
            // Facing walls have opposite normals; all are told along that of the first bundle.
            const double side =
                bundle.normal.dot(sorted.bundles()[sorted.buckets()[bucket].front()].normal) < 0 ? -1 : 1;
            inks.push_back({Ink::Kind::Lines, std::string("bundle") + static_cast<char>('A' + i % 26),
                            vectorlib::colour::distinct(i), 1.4,
                            "Bundle " + std::to_string(i + 1) + ": " + std::to_string(bundle.pairs.size()) +
                                (bundle.pairs.size() == 1 ? " pair, across " : " pairs, across ") +
                                decimals(side * bundle.shifts / bundle.length(), 2) + " m"});
            for (const int pair : bundle.pairs)
                drawing.segment(inks.back(),
                                example.linkOf(example.search.pairs()[static_cast<std::size_t>(pair)]));
        }
        figures.push_back({"bucket-" + std::to_string(bucket + 1),
                           "Figure 7.18: bucket " + std::to_string(bucket + 1) + " of " +
                               std::to_string(sorted.buckets().size()) + " with " +
                               std::to_string(sorted.buckets()[bucket].size()) + " bundles; " +
                               std::to_string(found.found - found.parts) + " combinations in all",
                           drawing, inks});
    }
}

// A near obstacle hides much from the first pose, and what was not seen hides things from the second.
void addExpectedView(std::vector<SearchFigure> &figures) {
    const std::vector<Point> room = {{0, 0}, {6, 0}, {6, 5}, {0, 5}},
                             box = {{1.5, 1.8}, {1.5, 2.2}, {1.9, 2.2}, {1.9, 1.8}};
    Segments world;
    for (const std::vector<Point> *corners : {&room, &box})
        for (std::size_t i = 0; i < corners->size(); ++i)
            world.emplace_back((*corners)[i], (*corners)[(i + 1) % corners->size()]);
    const Transformation2D first(0.9, 0.9, vectorlib::pi / 4), second(5.2, 3.2, -2.6);
    vectorlib::Observer<double> observe;
    vectorlib::Frontier frontier;
    Segments seen, explored;
    Drawing drawing;
    const auto fields = [&](const Ink &ink, const Transformation2D &from) {
        for (const Segment &s : seen)
            drawing.area(ink, {from.translation(), s.begin(), s.end()});
    };
    for (const auto &part : observe(world, first.pose()))
        seen.push_back(first * part.segment);
    for (const Segment &part : frontier(observe(seen, first.pose())))
        explored.push_back(first * part);
    fields(firstField, first);
    const Segments fixed = std::move(seen);
    seen.clear();
    for (const auto &part : observe(fixed, second.pose(), explored))
        seen.push_back(second * part.segment);
    fields(secondField, second);
    drawing.segments(border, explored);
    drawing.segments(expectedPart, seen);
    drawing.segments(staticSet, fixed);
    drawing.pose(sensor, first.pose());
    drawing.pose(sensor, second.pose());
    figures.push_back({"expected-view",
                       "Figure 7.19: what was not explored hides what lies behind it",
                       drawing,
                       {firstField, secondField, staticSet, expectedPart, border, sensor}});
}

void addDiscrepancies(std::vector<SearchFigure> &figures, Example &example) {
    std::vector<Ink> inks;
    for (const Ink *ink : caseInks())
        inks.push_back(*ink);
    bool hasTrue = false, hasWrong = false;
    for (const vectorlib::Solution &solution : example.within(1.2).search.solutions) {
        bool &known = example.report.scans.isTrue(solution) ? hasTrue : hasWrong;
        if (known || (&known == &hasWrong && solution.accepted))
            continue;
        known = true;
        const std::string of = &known == &hasTrue ? "the correct" : "a wrong";
        figures.push_back({&known == &hasTrue ? "correct" : "wrong",
                           "Figure 7.20: discrepancy of " + of +
                               " set of correspondences: " + decimals(solution.view.discrepancy, 3) + " of " +
                               decimals(solution.view.common, 1) + " square metres",
                           drawSolution(example.report, solution), inks});
    }
}

} // namespace

std::vector<SearchFigure> searchFigures(std::uint64_t seed) {
    Example example(seed);
    std::vector<SearchFigure> figures;
    addScans(figures, example);
    addPotentialPairs(figures, example);
    addBuckets(figures, example);
    addExpectedView(figures);
    addDiscrepancies(figures, example);
    return figures;
}

void writeSvg(std::ostream &out, const SearchFigure &figure) {
    constexpr std::size_t inRow = 3;
    constexpr double width = 900, height = 760, margin = 20, rowHeight = 20;
    const std::size_t rows = (figure.inks.size() + inRow - 1) / inRow;
    const double top = 44 + rowHeight * static_cast<double>(rows);
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << Fixed{width, 0} << "\" height=\""
        << Fixed{top + height, 0} << "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n<text x=\"" << margin
        << "\" y=\"26\" font-size=\"16\" font-weight=\"bold\">" << vectorlib::xmlText(figure.title)
        << "</text>\n";
    for (std::size_t i = 0; i < figure.inks.size(); ++i)
        writeSvgLegend(out, {&figure.inks[i]}, margin + 290 * static_cast<double>(i % inRow),
                       50 + rowHeight * static_cast<double>(i / inRow));
    figure.drawing.writeSvg(out, margin, top, width - 2 * margin, height - margin);
    out << "</svg>\n";
}

void writeLatex(std::ostream &out, const std::vector<SearchFigure> &figures) {
    vectorlib::LatexExport document(out);
    for (const SearchFigure &figure : figures) {
        document.latex("\\begin{minipage}{\\textwidth}\n\\subsection*{" + vectorlib::latexText(figure.title) +
                       "}\n");
        document.drawing(figure.drawing.picture(), {14, 9, Drawing::gridStep});
        document.latex("\n\n\\smallskip\n");
        std::vector<const Ink *> inks;
        for (const Ink &ink : figure.inks)
            inks.push_back(&ink);
        document.legend(layersOf(inks));
        document.latex("\\end{minipage}\\par\\bigskip\n");
    }
    document.finish();
}

} // namespace hermes::experiments
