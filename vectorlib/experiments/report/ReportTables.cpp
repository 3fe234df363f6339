#include "vectorlib/experiments/report/Report.h"

#include "vectorlib/io/Number.h"

#include <nlohmann/json.hpp>

namespace hermes::experiments {

using Json = nlohmann::ordered_json;
using vectorlib::Number;

namespace {

Json jsonOf(const vectorlib::Transformation2D &t) {
    return {{"x", t.x()}, {"y", t.y()}, {"alpha", t.alpha()}};
}

Json jsonOf(const Segments &segments) {
    Json list = Json::array();
    for (const vectorlib::LineSegment2D<double> &s : segments)
        list.push_back({s.begin().x, s.begin().y, s.end().x, s.end().y});
    return list;
}

Json jsonOf(const CaseReport &report, std::size_t i) {
    const vectorlib::Solution &s = report.result.solutions[i];
    const PairCounts &counts = report.counts[i];
    Json pairs = Json::array();
    for (const vectorlib::CorrespondencePair &p : s.pairs)
        pairs.push_back({p.fixed, p.moving});
    Json json = {{"number", i},
                 {"pose", jsonOf(s.pose)},
                 {"pairs", pairs},
                 {"reliability", s.reliability},
                 {"ambiguity", s.ambiguity},
                 {"discrepancy", s.view.discrepancy},
                 {"common_area", s.view.common},
                 {"shared_angle", s.view.angle},
                 {"matched_share", s.matchedShare},
                 {"score", s.score},
                 {"accepted", s.accepted},
                 {"true", report.scans.isTrue(s)},
                 {"true_positive", counts.truePositive},
                 {"true_negative", counts.trueNegative},
                 {"false_positive", counts.falsePositive},
                 {"false_negative", counts.falseNegative}};
    if (!report.doubts.empty())
        json["doubt"] = report.doubts[i] == vectorlib::Fault::None ? "" : describe(report.doubts[i]);
    return json;
}

Json headOf(const ReportWorld &world, const ReportSettings &settings) {
    const vectorlib::SearchSettings &s = settings.search;
    return {{"environment", world.world.name},
            {"description", world.description},
            {"noise", settings.scan.noise},
            {"rays", settings.scan.rays},
            {"seed", settings.scan.seed},
            {"settings",
             {{"max_dx", s.permitted.dx},
              {"max_dy", s.permitted.dy},
              {"max_dalpha", s.permitted.dalpha},
              {"sigma", settings.scan.sigma},
              {"reliability", s.reliability},
              {"ambiguity", s.ambiguity},
              {"k_alpha", s.stiffness.alpha},
              {"k_xy", s.stiffness.xy},
              {"every_combination", settings.everyCombination},
              {"discrepancy", s.discrepancy},
              {"discrepancy_share", s.discrepancyShare}}}};
}

Json searchOf(const CaseReport &report, const ReportSettings &settings) {
    const vectorlib::SearchResult &result = report.result;
    Json json = {{"outcome", describe(result.outcome)},
                 {"potential_pairs", result.potentialPairs},
                 {"bundles", result.bundles},
                 {"buckets", result.buckets},
                 {"combinations", result.combinations}};
    if (settings.everyCombination)
        json.update({{"found", report.found}, {"parts", report.parts}, {"left_out", report.leftOut}});
    return json;
}

Json caseOf(const CaseReport &report, const ReportSettings &settings) {
    Json json = {{"case", report.number},
                 {"truth", jsonOf(report.scans.truth)},
                 {"static", jsonOf(report.scans.fixed.segments)},
                 {"dynamic", jsonOf(report.scans.moving.segments)},
                 {"search", searchOf(report, settings)},
                 {"solutions", Json::array()}};
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i)
        json["solutions"].push_back(jsonOf(report, i));
    return json;
}

const std::string solutionColumns =
    "x,y,alpha,reliability,ambiguity_m2,discrepancy_m2,common_m2,shared_angle,"
    "matched_share,score,accepted,true,true_positive,true_negative,false_positive,"
    "false_negative";

void writeRow(std::ostream &out, const CaseReport &report, std::size_t i) {
    const vectorlib::Solution &s = report.result.solutions[i];
    const PairCounts &c = report.counts[i];
    for (const double value : {s.pose.x(), s.pose.y(), s.pose.alpha(), s.reliability, s.ambiguity,
                               s.view.discrepancy, s.view.common, s.view.angle, s.matchedShare, s.score})
        out << Number(value) << ',';
    out << s.accepted << ',' << report.scans.isTrue(s) << ',' << c.truePositive << ',' << c.trueNegative
        << ',' << c.falsePositive << ',' << c.falseNegative << '\n';
}

} // namespace

void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReport &report) {
    Json json = headOf(world, settings);
    json.update(caseOf(report, settings));
    out << json.dump(2) << '\n';
}

void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const CaseReports &report) {
    Json json = headOf(world, settings);
    json["cases"] = Json::array();
    for (const CaseReport &c : report.cases)
        json["cases"].push_back(caseOf(c, settings));
    out << json.dump(2) << '\n';
}

void writeJson(std::ostream &out, const ReportWorld &world, const ReportSettings &settings,
               const OverallReport &report) {
    Json json = headOf(world, settings);
    json["summary"] = {{"cases", report.cases.size()},
                       {"true_first", report.trueFirst()},
                       {"true_accepted", report.trueAccepted()},
                       {"wrong_accepted", report.wrongAccepted()},
                       {"doubted_accepted", report.doubtedAccepted()},
                       {"false_positives_of_first", report.falsePositives()}};
    json["cases"] = Json::array();
    for (const CaseReport &c : report.cases) {
        Json one = {{"case", c.number}, {"truth", jsonOf(c.scans.truth)}, {"search", searchOf(c, settings)}};
        one["accepted"] = Json::array();
        for (std::size_t i = 0; i < c.result.solutions.size(); ++i)
            if (c.result.solutions[i].accepted)
                one["accepted"].push_back(jsonOf(c, i));
        json["cases"].push_back(std::move(one));
    }
    out << json.dump(2) << '\n';
}

void writeCsv(std::ostream &out, const CaseReport &report) {
    out << "solution," << solutionColumns << '\n';
    for (std::size_t i = 0; i < report.result.solutions.size(); ++i) {
        out << i << ',';
        writeRow(out, report, i);
    }
}

void writeCsv(std::ostream &out, const CaseReports &report) {
    out << "case,solution," << solutionColumns << '\n';
    for (const CaseReport &c : report.cases)
        for (std::size_t i = 0; i < c.result.solutions.size(); ++i) {
            out << c.number << ',' << i << ',';
            writeRow(out, c, i);
        }
}

void writeCsv(std::ostream &out, const OverallReport &report) {
    const std::string noValues(
        1 + static_cast<std::size_t>(std::count(solutionColumns.begin(), solutionColumns.end(), ',')), ',');
    out << "from,to,solution," << solutionColumns << '\n';
    for (const CaseReport &c : report.cases) {
        bool any = false;
        for (std::size_t i = 0; i < c.result.solutions.size(); ++i)
            if (c.result.solutions[i].accepted) {
                out << c.number << ',' << c.number + 1 << ',' << i << ',';
                writeRow(out, c, i);
                any = true;
            }
        if (!any)
            out << c.number << ',' << c.number + 1 << ',' << noValues << '\n';
    }
}

} // namespace hermes::experiments
