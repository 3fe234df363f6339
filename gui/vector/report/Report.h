#pragma once

#include "gui/vector/report/Drawing.h"
#include "gui/vector/report/ScanPair.h"

#include <functional>

namespace hermes::vector {

/// With what a report is made. The defaults are those of the thesis appendices.
struct ReportSettings {
    ScanSettings scan;
    vectorlib::SearchSettings search;
};

/// The registration of two consecutive scans of a world. Thesis appendices A and C.
struct CaseReport {
    std::size_t number = 0; ///< scans number and number + 1
    ScanPair scans;
    vectorlib::SearchResult result;
    std::vector<PairCounts> counts; ///< of every solution
};

/// All consecutive pairs of scans of a world. Appendices B and D.
struct OverallReport {
    std::vector<CaseReport> cases;

    int trueFirst() const;      ///< cases whose first-ranked solution is true
    int trueAccepted() const;   ///< cases of which a true solution is accepted
    int wrongAccepted() const;  ///< accepted solutions that are not true
    int falsePositives() const; ///< wrong pairs in the first-ranked solutions
};

/// A world to report on, with what the reports say about it.
struct ReportWorld {
    World world;
    std::string description;
};

CaseReport reportCase(const World &world, std::size_t number, const ReportSettings &settings);
OverallReport reportOverall(const World &world, const ReportSettings &settings,
                            const std::function<void(std::size_t done, std::size_t all)> &progress = {});

void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report);
void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const OverallReport &report);
void writeCsv(std::ostream &out, const CaseReport &report);
void writeCsv(std::ostream &out, const OverallReport &report);
void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const CaseReport &report);
void writeSvg(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
              const OverallReport &report);
/// Documents that pdflatex compiles, laid out as the appendices.
void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const CaseReport &report);
void writeLatex(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
                const OverallReport &report);

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
std::vector<Fact> solutionFacts(const vectorlib::Solution &solution);
std::vector<Fact> countFacts(const PairCounts &counts);

/// The rows of the table of accepted solutions, nine cells each; a case without one has a row of dashes.
void forEachAccepted(const OverallReport &report,
                     const std::function<void(const std::vector<std::string> &cells)> &take);
/// One sentence.
std::string summaryOf(const OverallReport &report);

} // namespace hermes::vector
