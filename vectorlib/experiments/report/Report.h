#pragma once

#include "gui/vector/ProgressParts.h"
#include "vectorlib/experiments/report/Drawing.h"
#include "vectorlib/experiments/report/ScanPair.h"

namespace hermes::experiments {

using vector::ProgressParts;
using vector::ProgressSink;

/// With what a report is made. The defaults are those of the thesis appendices.
struct ReportSettings {
    ScanSettings scan;
    vectorlib::SearchSettings search;
    /// PublishedSearch instead of CorrespondenceFinder: every reliable, unambiguous combination of bundles,
    /// accepted where it is permitted and of little discrepancy.
    bool everyCombination = false;
    std::size_t maxCombinations = 100; ///< shown of a case
};

/// The registration of two consecutive scans of a world. Thesis appendices A and C.
struct CaseReport {
    std::size_t number = 0; ///< scans number and number + 1
    ScanPair scans;
    vectorlib::SearchResult result;
    std::vector<PairCounts> counts; ///< of every solution
    /// With every combination: what the published rules do not ask and the finder does, of every solution.
    std::vector<vectorlib::Fault> doubts;
    std::uint64_t found = 0;   ///< combinations that are reliable and unambiguous
    std::uint64_t parts = 0;   ///< of these parts of larger ones, which are not shown
    std::uint64_t leftOut = 0; ///< of these beyond the bounds
};

/// The case reports of all consecutive scans of a world.
struct CaseReports {
    std::vector<CaseReport> cases;
};

/// All consecutive pairs of scans of a world. Appendices B and D.
struct OverallReport {
    std::vector<CaseReport> cases;

    int trueFirst() const;       ///< cases whose first-ranked solution is true
    int trueAccepted() const;    ///< cases of which a true solution is accepted
    int wrongAccepted() const;   ///< accepted solutions that are not true
    int doubtedAccepted() const; ///< of these those with a doubt
    int falsePositives() const;  ///< wrong pairs in the first-ranked solutions
};

/// A world to report on, with what the reports say about it.
struct ReportWorld {
    World world;
    std::string description;
    std::string publishedCase,
        publishedOverall; ///< figures of the appendices for case 0 and for all, or none
};

CaseReport reportCase(const World &world, std::size_t number, const ReportSettings &settings);
OverallReport reportOverall(const World &world, const ReportSettings &settings,
                            const ProgressSink &progress = {});

void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report);
void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const OverallReport &report);
void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReports &report);
void writeCsv(std::ostream &out, const CaseReport &report);
void writeCsv(std::ostream &out, const CaseReports &report);
void writeCsv(std::ostream &out, const OverallReport &report);
void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReport &report);
void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const OverallReport &report);
void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReports &report);
/// Documents that pdflatex compiles, laid out as the appendices.
void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReport &report);
void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const OverallReport &report);
void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReports &report);

/// The inks of the pictures, in the order of the legend.
std::vector<const Ink *> caseInks();
std::vector<const Ink *> overallInks();
std::vector<const Ink *> allInks();
/// Both scans as they were taken, each from where its sensor stood.
Drawing drawScans(const CaseReport &report);
/// A solution: static scan, registered scan, correspondences, common and discrepancy areas.
Drawing drawSolution(const CaseReport &report, const vectorlib::Solution &solution);
/// The world and the poses of its scans.
Drawing drawWorld(const World &world);

/// A line of text of a report: "Reliability", "0.962".
struct Fact {
    std::string name, value;
};
std::vector<Fact> datasetFacts(const World &world, const ReportSettings &settings);
std::vector<Fact> observationFacts(const CaseReport &report);
std::vector<Fact> settingsFacts(const ReportSettings &settings);
std::vector<Fact> solutionFacts(const CaseReport &report, std::size_t solution);
std::vector<Fact> countFacts(const PairCounts &counts);
/// "Accepted" or "Rejected", and the doubt that there is about it.
std::string verdictOf(const CaseReport &report, std::size_t solution);
/// What the search looked at, how it ended and what it left out; then the published figures where there are
/// some.
std::string searchText(const ReportWorld &world, const CaseReport &report);

/// The rows of the table of accepted solutions, nine cells each; a case without one has a row of dashes.
void forEachAccepted(const OverallReport &report,
                     const std::function<void(const std::vector<std::string> &cells)> &take);
/// A few sentences.
std::string summaryOf(const ReportWorld &world, const OverallReport &report);

} // namespace hermes::experiments
