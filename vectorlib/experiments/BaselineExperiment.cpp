#include "vectorlib/experiments/BaselineExperiment.h"

#include "vectorlib/correspondence/QuadrangleMatcher.h"
#include "vectorlib/experiments/OverviewExperiment.h"
#include "vectorlib/experiments/ProcessorTime.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/similarity/CriterionMinimizer.h"

#include <algorithm>
#include <map>
#include <random>
#include <sstream>

namespace hermes::experiments {

using vector::quantile;

using vectorlib::Transformation2D;
using Segments = std::vector<vectorlib::LineSegment2D<double>>;
using RawEdges = std::vector<vectorlib::EdgeRaw2D>;

namespace {

/// Errors of the expected motion.
struct Off {
    double metres, degrees;
};
constexpr Off sizes[] = {{0.05, 1}, {0.1, 2}, {0.2, 5}, {0.3, 10}, {0.4, 15}, {0.6, 25}, {1, 40}};
constexpr std::size_t matchers = 4;
constexpr const char *names[matchers] = {"quadrangle", "older pairs with area", "tracker", "pair matcher"};

struct Found {
    Transformation2D motion;
    bool accepted = false;
};

Segments segmentsOf(const RawEdges &edges) {
    Segments segments;
    for (const vectorlib::EdgeRaw2D &edge : edges)
        segments.push_back(edge.segment);
    return segments;
}

/// The matchers, each with its published or default settings: permitted errors of 0.5 m and 0.4 rad.
class Matchers {
public:
    void take(const BaselinePair &pair) {
        pair_ = &pair;
        extract_.segment.settings = pair.segmentation;
        fixedEdges_ = extract_(pair.fixed);
        movingEdges_ = extract_(pair.moving);
        fixed_ = segmentsOf(fixedEdges_);
        moving_ = segmentsOf(movingEdges_);
    }
    Found operator()(std::size_t matcher, const Transformation2D &expected) {
        if (matcher == 0) {
            const vectorlib::QuadrangleMatch &match = quadrangle_(fixed_, moving_, expected);
            return {match.pose, match.accepted};
        }
        if (matcher == 1)
            return byArea(expected);
        if (matcher == 2) {
            const vectorlib::Match &match = track_(fixed_, movingEdges_, expected);
            return {match.accepted ? match.pose : expected, match.accepted};
        }
        const vectorlib::ScanPairMatch &match =
            matchPair_(pair_->fixed, fixedEdges_, pair_->moving, movingEdges_, expected);
        return {match.pose, match.accepted};
    }

private:
    // What the older selection of pairs gives when the newer criterion fits them.
    Found byArea(const Transformation2D &expected) {
        const Transformation2D toLocal = expected.inverse();
        Segments fixed;
        for (const auto &segment : fixed_)
            fixed.push_back(toLocal * segment);
        vectorlib::EdgeSetComparator criterion;
        for (const vectorlib::CorrespondencePair &pair : select_(fixed, moving_))
            criterion.add(fixed[std::size_t(pair.fixed)], moving_[std::size_t(pair.moving)]);
        if (criterion.pairs() < 2)
            return {expected, false};
        const vectorlib::CriterionMinimum found =
            vectorlib::CriterionMinimizer()(criterion, Transformation2D());
        return {expected * found.transformation, found.converged};
    }

    const BaselinePair *pair_ = nullptr;
    vectorlib::EdgeExtractor extract_;
    vectorlib::QuadrangleMatcher quadrangle_;
    vectorlib::OverlapSelection select_;
    vectorlib::CorrespondenceTracker track_;
    vectorlib::ScanPairMatcher matchPair_;
    RawEdges fixedEdges_, movingEdges_;
    Segments fixed_, moving_;
};

struct Account {
    BaselineRow row;
    std::vector<double> metres, degrees;

    void take(const BaselinePair &pair, const Found &found) {
        LogPair errors;
        errors.reference = pair.motion;
        ++row.tries;
        row.right += errors.isWithin(found.motion, 0.10);
        row.accepted += found.accepted;
        row.acceptedWrong += found.accepted && errors.isWrong(found.motion);
        metres.push_back(errors.errorMetres(found.motion));
        degrees.push_back(errors.errorDegrees(found.motion));
    }
    BaselineRow conclude() {
        row.medianMetres = quantile(metres, 0.5);
        row.medianDegrees = quantile(degrees, 0.5);
        row.microseconds /= std::max(1.0, double(row.tries));
        return row;
    }
};

Transformation2D offBy(const Off &off, std::mt19937_64 &random) {
    std::uniform_real_distribution<double> angle(-vectorlib::pi, vectorlib::pi);
    const double direction = angle(random), turn = off.degrees * vectorlib::pi / 180;
    return {off.metres * std::cos(direction), off.metres * std::sin(direction),
            angle(random) < 0 ? -turn : turn};
}

} // namespace

BaselineSet baselineSet(const World &world, std::uint64_t seed) {
    BaselineSet set{world.name, {}};
    const OverviewRun run = overviewRun(world, OdometryErrors(), seed);
    for (std::size_t i = 1; i < run.scans.size(); ++i)
        set.pairs.push_back(
            {run.scans[i - 1].points, run.scans[i].points,
             Transformation2D(run.scans[i - 1].truth).inverse() * Transformation2D(run.scans[i].truth),
             vectorlib::EarSettings()});
    return set;
}

BaselineSet baselineSet(const std::string &name, const vectorlib::CarmenLog &log,
                        const PairsOptions &options) {
    BaselineSet set{name, {}};
    for (const std::size_t from : options.pairsOf(log)) {
        const vectorlib::CarmenScan &first = log.scans[from];
        set.pairs.push_back({pointsOf(first), pointsOf(log.scans[from + options.every]),
                             log.referenceMotion(from, from + options.every),
                             vectorlib::EarSettings::forScanner(first.angleStep * double(first.ranges.size()),
                                                                first.ranges.size())});
    }
    return set;
}

std::vector<BaselineRow> baselineExperiment(const std::vector<BaselineSet> &sets, std::uint64_t seed,
                                            int runs, const ProgressSink &progress) {
    std::vector<BaselineRow> rows;
    Matchers match;
    std::vector<std::size_t> steps;
    for (const BaselineSet &set : sets)
        steps.push_back(set.pairs.size());
    ProgressParts parts(progress, steps);
    for (const BaselineSet &set : sets) {
        const ProgressSink tell = parts.next();
        std::vector<Account> accounts;
        for (const Off &off : sizes)
            for (const char *name : names)
                accounts.push_back({{set.name, name, off.metres, off.degrees}, {}, {}});
        std::mt19937_64 random(seed);
        for (std::size_t i = 0; i < set.pairs.size(); ++i) {
            match.take(set.pairs[i]);
            for (std::size_t s = 0; s < std::size(sizes); ++s)
                for (int run = 0; run < runs; ++run) {
                    const Transformation2D expected = set.pairs[i].motion * offBy(sizes[s], random);
                    for (std::size_t m = 0; m < matchers; ++m) {
                        Account &account = accounts[s * matchers + m];
                        const double begin = processorMicroseconds();
                        const Found found = match(m, expected);
                        account.row.microseconds += processorMicroseconds() - begin;
                        account.take(set.pairs[i], found);
                    }
                }
            tell(i + 1, set.pairs.size());
        }
        for (Account &account : accounts)
            rows.push_back(account.conclude());
    }
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<BaselineRow> &rows) {
    using vectorlib::Number;
    out << "set,matcher,off_m,off_deg,tries,right,right_share,accepted,accepted_wrong,median_error_m,"
           "median_error_deg,time_us\n";
    for (const BaselineRow &r : rows)
        out << r.set << ',' << r.matcher << ',' << Number(r.offMetres) << ',' << Number(r.offDegrees) << ','
            << r.tries << ',' << r.right << ',' << Number(r.rightShare()) << ',' << r.accepted << ','
            << r.acceptedWrong << ',' << Number(r.medianMetres) << ',' << Number(r.medianDegrees) << ','
            << Number(r.microseconds) << '\n';
}

nlohmann::ordered_json summaryOf(const std::vector<BaselineRow> &rows) {
    nlohmann::ordered_json json;
    std::map<std::pair<std::string, std::string>, double> times;
    for (const BaselineRow &r : rows) {
        nlohmann::ordered_json &of = json[r.set][r.matcher];
        std::ostringstream off;
        off << r.offMetres << " m, " << r.offDegrees << " deg";
        of["right_share"][off.str()] = r.rightShare();
        if (r.offMetres == sizes[0].metres) {
            of["median_error_m"] = r.medianMetres;
            of["median_error_deg"] = r.medianDegrees;
        }
        times[{r.set, r.matcher}] += r.microseconds;
    }
    for (const auto &[of, time] : times)
        json[of.first][of.second]["time_over_tracker"] = time / times[{of.first, names[2]}];
    return json;
}

std::vector<Plot> plotsOf(const std::vector<BaselineRow> &rows) {
    std::vector<Plot> plots;
    for (const BaselineRow &r : rows) {
        if (plots.empty() || plots.back().name != r.set)
            plots.push_back({r.set,
                             r.set + ": matches within 10 cm and 2 degrees",
                             "error of the expected motion [m], with 1 to 40 degrees",
                             "share",
                             true,
                             false,
                             {}});
        std::vector<Curve> &curves = plots.back().curves;
        const auto own = std::find_if(curves.begin(), curves.end(),
                                      [&](const Curve &curve) { return curve.label == r.matcher; });
        Curve &curve =
            own != curves.end()
                ? *own
                : curves.emplace_back(Curve{r.matcher, vectorlib::colour::distinct(curves.size()), {}});
        curve.points.emplace_back(r.offMetres, r.rightShare());
    }
    return plots;
}

} // namespace hermes::experiments
