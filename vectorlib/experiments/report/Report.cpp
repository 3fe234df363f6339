#include "vectorlib/experiments/report/Report.h"

#include "vectorlib/correspondence/PublishedSearch.h"

namespace hermes::experiments {

namespace {

void searchAsPublished(CaseReport &report, const ReportSettings &settings) {
    vectorlib::PublishedSearch search;
    search.settings = settings.search;
    search.combine.keep = settings.maxCombinations;
    const vectorlib::PublishedResult &found =
        search(report.scans.fixed.segments, report.scans.moving.segments);
    report.result = found.search;
    report.doubts = found.doubts;
    report.found = found.found;
    report.parts = found.parts;
    report.leftOut = found.leftOut;
}

} // namespace

CaseReport reportCase(const World &world, std::size_t number, const ReportSettings &settings) {
    ScanSettings scan = settings.scan;
    scan.seed = settings.scan.seed * 1000003 + number;
    CaseReport report;
    report.number = number;
    report.scans = scanPair(edgesOf(world), world.poses.at(number), world.poses.at(number + 1), scan);
    if (settings.everyCombination) {
        searchAsPublished(report, settings);
    } else {
        vectorlib::CorrespondenceFinder find;
        find.settings = settings.search;
        report.result = find(report.scans.fixed.segments, report.scans.moving.segments);
    }
    for (const vectorlib::Solution &solution : report.result.solutions)
        report.counts.push_back(report.scans.count(solution, settings.search.permitted));
    return report;
}

OverallReport reportOverall(const World &world, const ReportSettings &settings,
                            const ProgressSink &progress) {
    OverallReport report;
    for (std::size_t i = 0; i + 1 < world.poses.size(); ++i) {
        report.cases.push_back(reportCase(world, i, settings));
        if (progress)
            progress(i + 1, world.poses.size() - 1);
    }
    return report;
}

int OverallReport::trueFirst() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += !c.result.solutions.empty() && c.scans.isTrue(c.result.solutions[0]);
    return count;
}

int OverallReport::trueAccepted() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += std::any_of(c.result.solutions.begin(), c.result.solutions.end(),
                             [&](const vectorlib::Solution &s) { return s.accepted && c.scans.isTrue(s); });
    return count;
}

int OverallReport::wrongAccepted() const {
    int count = 0;
    for (const CaseReport &c : cases)
        for (const vectorlib::Solution &s : c.result.solutions)
            count += s.accepted && !c.scans.isTrue(s);
    return count;
}

int OverallReport::doubtedAccepted() const {
    int count = 0;
    for (const CaseReport &c : cases)
        for (std::size_t i = 0; i < c.doubts.size(); ++i)
            count += c.doubts[i] != vectorlib::Fault::None && c.result.solutions[i].accepted &&
                     !c.scans.isTrue(c.result.solutions[i]);
    return count;
}

int OverallReport::falsePositives() const {
    int count = 0;
    for (const CaseReport &c : cases)
        count += c.counts.empty() ? 0 : c.counts[0].falsePositive;
    return count;
}

} // namespace hermes::experiments
