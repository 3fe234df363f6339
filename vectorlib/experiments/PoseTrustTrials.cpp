#include "vectorlib/experiments/PoseTrustTrials.h"

#include "vectorlib/experiments/Calibration.h"
#include "vectorlib/experiments/DrawnDrive.h"
#include "vectorlib/experiments/LogisticFit.h"
#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/io/CarmenDrive.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/mapping/ScanTracker.h"

#include <map>
#include <memory>

namespace hermes::experiments {

using vectorlib::CarmenLog;
using vectorlib::Pose2D;
using vectorlib::PoseTrust;
using vectorlib::Transformation2D;

namespace {

constexpr std::size_t before = 5; // poses
constexpr double sure = 0.9;
constexpr std::size_t eachNth[] = {1, 5}; // scan of a log

/// Follows one drive and judges its poses.
class Judge {
public:
    vectorlib::ScanTracker tracker;

    void take(vectorlib::TimedScan &scan, const Pose2D &reference) {
        if (found_.empty())
            tracker.place(reference);
        found_.emplace_back(tracker.process(scan).pose);
        reference_.emplace_back(reference);
    }
    /// Nothing where the last pose was not found in a map.
    std::optional<PoseTrial> last() const {
        if (found_.size() < 2 || !tracker.trustFeatures())
            return std::nullopt;
        PoseTrial trial;
        trial.scan = found_.size() - 1;
        trial.features = *tracker.trustFeatures();
        const std::size_t compared = std::min(before, trial.scan);
        std::size_t right = 0;
        for (std::size_t i = 1; i <= compared; ++i)
            right += agrees(trial.scan - i, trial.scan);
        trial.isRight = 2 * right > compared;
        return trial;
    }

private:
    bool agrees(std::size_t from, std::size_t to) const {
        const LogPair pair{from, to, reference_[from].inverse() * reference_[to]};
        return pair.isWithin(found_[from].inverse() * found_[to], 0.10);
    }
    std::vector<Transformation2D> found_, reference_;
};

void follow(const CarmenLog &log, std::size_t every, bool useOdometry, const PoseTrial &kind,
            std::vector<PoseTrial> &trials, const std::function<void()> &tell) {
    constexpr auto corrected = vectorlib::CarmenOdometryKind::Corrected;
    const auto judge = std::make_unique<Judge>();
    vectorlib::ScanTrackerSettings settings;
    settings.useOdometry = useOdometry;
    settings.seekWhereContradicted = false; // each pose is judged
    judge->tracker.apply(settings);
    vectorlib::CarmenDrive drive(log, corrected);
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
        const vectorlib::CarmenScan &source = log.scans[i];
        drive.advance();
        vectorlib::TimedScan scan;
        scan.points = pointsOf(source);
        if (i % every != 0)
            continue;
        tell();
        if (drive.isRepeated() || scan.points.empty())
            continue;
        scan.stamp = source.stamp;
        scan.odometry = drive.odometry();
        scan.rays = source.ranges.size();
        scan.fieldOfView = source.angleStep * double(source.ranges.size());
        scan.closed = scan.fieldOfView > 2 * vectorlib::pi - 1e-3;
        judge->take(scan, source.laserPose);
        if (auto trial = judge->last()) {
            trial->set = kind.set;
            trial->part = kind.part == PoseTrial::Part::Never ? kind.part
                          : trial->scan / 50 % 2 == 0         ? PoseTrial::Part::First
                                                              : PoseTrial::Part::Second;
            trials.push_back(*trial);
        }
    }
}

using Cases = std::vector<LogisticCase<std::tuple_size<PoseTrust::Features>::value>>;

template <typename Belongs>
Cases casesOf(const std::vector<PoseTrial> &trials, Belongs belongs) {
    Cases cases;
    for (const PoseTrial &t : trials)
        if (belongs(t))
            cases.push_back({t.features, t.isRight});
    return cases;
}

nlohmann::ordered_json qualityOf(const PoseTrust &trust, const Cases &cases) {
    std::size_t right = 0, toldSure = 0, wrongSure = 0;
    double told = 0;
    for (const auto &c : cases) {
        const double p = trust(c.features);
        told += p;
        right += c.right;
        toldSure += p > sure;
        wrongSure += p > sure && !c.right;
    }
    const double count = std::max<double>(1, double(cases.size()));
    return {{"poses", cases.size()},          {"told", told / count},
            {"right", double(right) / count}, {"loss", logisticLoss(cases, trust)},
            {"above_0.9", toldSure},          {"above_0.9_wrong", wrongSure}};
}

nlohmann::ordered_json tenthsOf(const PoseTrust &trust, const Cases &cases) {
    CalibrationTenths tenths;
    for (const auto &c : cases)
        add(tenths, trust(c.features), c.right);
    toMeans(tenths);
    nlohmann::ordered_json json;
    for (const CalibrationTenth &t : tenths)
        json.push_back({{"poses", t.solutions}, {"told", t.told}, {"right", t.right}});
    return json;
}

const char *name(PoseTrial::Part part) {
    return part == PoseTrial::Part::First    ? "first half"
           : part == PoseTrial::Part::Second ? "second half"
                                             : "never fitted";
}

} // namespace

std::size_t countPoses(const CarmenLog &log) {
    std::size_t count = 0;
    for (const std::size_t every : eachNth)
        count += 2 * ((log.scans.size() + every - 1) / every);
    return count;
}

std::size_t countPoses(int drives) {
    return std::size_t(drives) * DrawnDrive::scans;
}

std::vector<PoseTrial> posesOfLog(const std::string &name, const CarmenLog &log, bool strange,
                                  const ProgressSink &progress) {
    std::vector<PoseTrial> trials;
    std::size_t done = 0;
    const auto tell = [&, all = countPoses(log)] {
        ++done;
        if (progress)
            progress(done, all);
    };
    PoseTrial kind;
    kind.part = strange ? PoseTrial::Part::Never : PoseTrial::Part::First;
    for (const std::size_t every : eachNth)
        for (const bool useOdometry : {true, false}) {
            kind.set = name + (every == 1 ? "" : ", each fifth scan") + (useOdometry ? "" : ", no odometry");
            follow(log, every, useOdometry, kind, trials, tell);
        }
    return trials;
}

std::vector<PoseTrial> posesOfDrawnDrives(std::uint64_t seed, int drives, const ProgressSink &progress) {
    std::vector<PoseTrial> trials;
    for (int i = 0; i < drives; ++i) {
        DrawnDrive drive(unsigned(seed * 1000 + std::uint64_t(i)));
        const auto judge = std::make_unique<Judge>();
        vectorlib::TimedScan scan;
        for (int k = 0; k < DrawnDrive::scans; ++k) {
            drive.take(scan);
            judge->take(scan, drive.truth());
            if (auto trial = judge->last()) {
                trial->set = "drawn " + drive.kind();
                trial->part = i % 2 == 0 ? PoseTrial::Part::First : PoseTrial::Part::Second;
                trials.push_back(*trial);
            }
        }
        if (progress)
            progress(std::size_t(i + 1), std::size_t(drives));
    }
    return trials;
}

PoseTrust fittedPoseTrust(const std::vector<PoseTrial> &trials) {
    const Cases cases = casesOf(trials, [](const PoseTrial &t) { return t.part == PoseTrial::Part::First; });
    PoseTrust fitted;
    fitted.weights = logisticFit(cases, 1);
    return fitted;
}

nlohmann::ordered_json poseTrustSummary(const std::vector<PoseTrial> &trials) {
    using Part = PoseTrial::Part;
    std::map<std::pair<Part, std::string>, bool> sets;
    for (const PoseTrial &t : trials)
        sets[{t.part, t.set}] = true;
    nlohmann::ordered_json json;
    for (const auto &[when, trust] :
         {std::pair("present", PoseTrust()), std::pair("fitted", fittedPoseTrust(trials))}) {
        nlohmann::ordered_json &of = json[when];
        of["weights"] = trust.weights;
        for (const Part part : {Part::First, Part::Second, Part::Never}) {
            const Cases cases = casesOf(trials, [&](const PoseTrial &t) { return t.part == part; });
            of[name(part)] = qualityOf(trust, cases);
            of[name(part)]["tenths"] = tenthsOf(trust, cases);
            for (const auto &[key, unused] : sets)
                if (key.first == part)
                    of[name(part)]["sets"][key.second] =
                        qualityOf(trust, casesOf(trials, [&k = key](const PoseTrial &t) {
                                      return t.part == k.first && t.set == k.second;
                                  }));
        }
    }
    return json;
}

void writeCsv(std::ostream &out, const std::vector<PoseTrial> &trials) {
    using vectorlib::Number;
    out << "set,part,scan,right,told,reliability,apart,log_pairs,log_off,matched_share\n";
    const PoseTrust trust;
    for (const PoseTrial &t : trials) {
        out << '"' << t.set << "\"," << name(t.part) << ',' << t.scan << ',' << t.isRight << ','
            << Number(trust(t.features));
        for (std::size_t i = 1; i < t.features.size(); ++i)
            out << ',' << Number(t.features[i]);
        out << '\n';
    }
}

} // namespace hermes::experiments
