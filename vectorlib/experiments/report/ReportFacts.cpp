#include "vectorlib/experiments/report/Report.h"

#include "vectorlib/io/Number.h"

#include <sstream>

namespace hermes::experiments {

using vectorlib::Fixed;

namespace {

std::string text(double value, int decimals, const char *unit = "") {
    std::ostringstream out;
    out << Fixed{value, decimals} << unit;
    return out.str();
}

} // namespace

std::vector<Fact> datasetFacts(const World &world, const ReportSettings &settings) {
    return {{"Environment", world.name},
            {"Noise sigma", text(100 * settings.scan.noise, 1, " cm")},
            {"Rays of a scan", std::to_string(settings.scan.rays)},
            {"Seed", std::to_string(settings.scan.seed)},
            {"Grid", "50 x 50 cm"}};
}

std::vector<Fact> observationFacts(const CaseReport &report) {
    const vectorlib::Transformation2D &truth = report.scans.truth;
    return {
        {"Scan points", "#" + std::to_string(report.number) + " to #" + std::to_string(report.number + 1)},
        {"True dx", text(100 * truth.x(), 0, " cm")},
        {"True dy", text(100 * truth.y(), 0, " cm")},
        {"True dalpha", text(truth.alpha(), 2, " rad")}};
}

std::vector<Fact> settingsFacts(const ReportSettings &settings) {
    const vectorlib::SearchSettings &s = settings.search;
    return {{"Maximal |dx|", text(100 * s.permitted.dx, 0, " cm")},
            {"Maximal |dy|", text(100 * s.permitted.dy, 0, " cm")},
            {"Maximal |dalpha|", text(s.permitted.dalpha, 2, " rad")},
            {"Vectorization max. error", text(100 * settings.scan.sigma, 1, " cm")},
            {"Reliability threshold", text(s.reliability, 2)},
            {settings.everyCombination ? "Ambiguity threshold, sum" : "Ambiguity threshold, a pair",
             text(1e4 * s.ambiguity, 1, " cm2")},
            {"Ambiguity k alpha", text(1e4 * s.stiffness.alpha, 0, " cm2/rad2")},
            {"Ambiguity k xy", text(s.stiffness.xy, 1)},
            {"Discrepancy threshold",
             text(1e4 * s.discrepancy, 0, " cm2") +
                 (settings.everyCombination ? "" : " or " + text(100 * s.discrepancyShare, 0, " %"))}};
}

std::vector<Fact> solutionFacts(const CaseReport &report, std::size_t number) {
    const vectorlib::Solution &solution = report.result.solutions[number];
    std::vector<Fact> facts = {{"Reliability", text(solution.reliability, 3)},
                               {"Ambiguity", text(1e4 * solution.ambiguity, 2, " cm2")},
                               {"Discrepancy", text(1e4 * solution.view.discrepancy, 0, " cm2")}};
    if (report.doubts.empty()) {
        facts.push_back({"Matched", text(100 * solution.matchedShare, 0, " %")});
        facts.push_back({"Score", text(solution.score, 3)});
    }
    return facts;
}

std::vector<Fact> countFacts(const PairCounts &counts) {
    return {{"True positive", std::to_string(counts.truePositive)},
            {"True negative", std::to_string(counts.trueNegative)},
            {"False positive", std::to_string(counts.falsePositive)},
            {"False negative", std::to_string(counts.falseNegative)}};
}

std::string verdictOf(const CaseReport &report, std::size_t number) {
    const vectorlib::Solution &solution = report.result.solutions[number];
    if (!solution.accepted)
        return solution.fault == vectorlib::Fault::NotPermitted
                   ? std::string("Rejected: ") + describe(solution.fault)
                   : "Rejected";
    if (report.doubts.empty() || report.doubts[number] == vectorlib::Fault::None)
        return "Accepted";
    return std::string("Accepted, although ") + describe(report.doubts[number]);
}

std::string searchText(const ReportWorld &world, const CaseReport &report) {
    const vectorlib::SearchResult &result = report.result;
    std::string text = std::to_string(result.potentialPairs) + " potential pairs, " +
                       std::to_string(result.bundles) + " bundles, " + std::to_string(result.buckets) +
                       " buckets, " + std::to_string(result.combinations) + " bundles tried; " +
                       describe(result.outcome) + ".";
    if (report.found > 0)
        text += " Reliable, unambiguous combinations: " + std::to_string(report.found) + ", of them " +
                std::to_string(report.parts) + " part of a larger one and not shown, " +
                std::to_string(report.leftOut) + " left out, the shortest ones.";
    return text + (report.number == 0 && !world.publishedCase.empty() ? " " + world.publishedCase : "");
}

void forEachAccepted(const OverallReport &report,
                     const std::function<void(const std::vector<std::string> &cells)> &take) {
    for (const CaseReport &c : report.cases) {
        const std::string scans = "#" + std::to_string(c.number) + " to #" + std::to_string(c.number + 1);
        bool any = false;
        for (std::size_t i = 0; i < c.result.solutions.size(); ++i) {
            const vectorlib::Solution &s = c.result.solutions[i];
            if (!s.accepted)
                continue;
            const bool isDoubted = !c.doubts.empty() && c.doubts[i] != vectorlib::Fault::None;
            std::vector<std::string> cells = {scans, std::to_string(i) + (isDoubted ? "*" : ""),
                                              text(s.reliability, 3), text(1e4 * s.ambiguity, 2),
                                              text(1e4 * s.view.discrepancy, 0)};
            for (const Fact &fact : countFacts(c.counts[i]))
                cells.push_back(fact.value);
            take(cells);
            any = true;
        }
        if (!any)
            take({scans, "-", "-", "-", "-", "-", "-", "-", "-"});
    }
}

std::string summaryOf(const ReportWorld &world, const OverallReport &report) {
    std::string text = "True solution ranked first in " + std::to_string(report.trueFirst()) + " of " +
                       std::to_string(report.cases.size()) + " cases and accepted in " +
                       std::to_string(report.trueAccepted()) +
                       "; wrong solutions accepted: " + std::to_string(report.wrongAccepted());
    if (report.doubtedAccepted() > 0)
        text += ", " + std::to_string(report.doubtedAccepted()) + " of them not by the finder (*)";
    text += "; wrong pairs in the first-ranked solutions: " + std::to_string(report.falsePositives()) + ".";
    return text + (world.publishedOverall.empty() ? "" : " " + world.publishedOverall);
}

} // namespace hermes::experiments
