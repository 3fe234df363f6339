// Drawn drives whose scanner is not what its log says: scans that were not taken at once, mirrored ones, a
// sensor that is turned on the robot. The map must be right, or the option be named that makes it so.
#include "tests/gui/SimulatedLog.h"
#include "tests/gui/VectorProgram.h"

using vectorlib::pi;
using vectorlib::Pose2D;
using vectorlib::Transformation2D;

constexpr double between_s = 0.1; // scans

/// A robot that turns fast: a pose each hundredth of a second.
class FastDrive {
public:
    FastDrive(double speed, double rate)
        : speed_(speed)
        , rate_(rate) {}

    /// spins: at so many places it turns once around, to either side.
    void follow(std::vector<Pose2D> way, int spins) {
        for (int spin = 1; spin <= spins; ++spin) {
            const auto at = way.begin() + long(way.size()) * spin / (spins + 1);
            std::vector<Pose2D> turns(4, *at);
            for (int i = 0; i < 4; ++i)
                turns[i].theta += (spin % 2 ? 1 : -1) * (i + 1) * pi / 2;
            way.insert(at + 1, turns.begin(), turns.end());
        }
        poses_ = {way.front()};
        for (const Pose2D &to : way) {
            const Pose2D step = poses_.back().inverse() * to;
            const double seconds = std::max(std::hypot(step.x, step.y) / speed_,
                                            std::abs(std::remainder(step.theta, 2 * pi)) / rate_);
            const int steps = int(seconds / tick_s) + 1;
            const auto twist = vectorlib::Twist2D::between(
                {step.x, step.y, std::remainder(step.theta, 2 * pi)}, steps * tick_s);
            const Pose2D from = poses_.back();
            for (int i = 1; seconds > 1e-6 && i <= steps; ++i)
                poses_.push_back(from * twist.motion(i * tick_s));
        }
    }
    double end() const { return double(poses_.size() - 1) * tick_s; }
    Pose2D at(double seconds) const {
        const double at = std::clamp(seconds / tick_s, 0.0, double(poses_.size() - 1));
        const std::size_t i = std::min(std::size_t(at), poses_.size() - 2);
        const Pose2D step = poses_[i].inverse() * poses_[i + 1];
        return poses_[i] * vectorlib::Twist2D::between(step, 1).motion(at - double(i));
    }

private:
    static constexpr double tick_s = 0.01;
    double speed_, rate_;
    std::vector<Pose2D> poses_;
};

class TestScannerLogs : public QObject, protected TestFolder {
    Q_OBJECT

    std::mt19937 random_;
    FastDrive drive_{0, 0};
    double fieldOfView_ = 0;

    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }

    void draw(unsigned seed) {
        random_.seed(seed);
        fieldOfView_ = QList<double>{pi, 1.5 * pi, 2 * pi}[int(random_() % 3)];
        drive_ = FastDrive(between(0.6, 1), between(1.8, 3));
    }
    // secondsPerTurn: below 0 for clockwise.
    QByteArray log(const ScanWorld &world, double secondsPerTurn, const Pose2D &mount, bool isMirrored) {
        constexpr int rays = 271;
        const double step = fieldOfView_ / (rays - 1);
        QByteArray text;
        for (double stamp = 0.1; stamp < drive_.end() - 0.1; stamp += between_s) {
            QByteArrayList ranges;
            for (int i = 0; i < rays; ++i) {
                const double angle = step * i - fieldOfView_ / 2;
                const Pose2D sensor =
                    drive_.at(stamp + secondsPerTurn * angle / (2 * pi)) * mount * Pose2D{0, 0, angle};
                const auto hit = world.scan(Transformation2D(sensor), random_, {2, 0, 0.005, 25});
                ranges += QByteArray::number(hit.empty() ? 30 : double(hit[0].norm()), 'f', 3);
            }
            if (isMirrored)
                std::reverse(ranges.begin(), ranges.end());
            const QByteArray pose = SimulatedLog::pose(drive_.at(stamp)) + ' ',
                             at = QByteArray::number(stamp, 'f', 6);
            text += "ROBOTLASER1 0 " + QByteArray::number(-fieldOfView_ / 2, 'f', 8) + ' ' +
                    QByteArray::number(fieldOfView_, 'f', 8) + ' ' + QByteArray::number(step, 'f', 8) +
                    " 30 0.01 0 " + QByteArray::number(rays) + ' ' + ranges.join(' ') + " 0 " + pose + pose +
                    "0 0 0 0 0 " + at + " robot " + at + '\n';
        }
        return text;
    }
    // The farthest of the poses of a map from where the sensor was.
    double farthest(const QStringList &options, const Pose2D &mount, QByteArray *told = nullptr) {
        const Result r =
            ran(QStringList{"map", path("in.log"), "--out-trajectory", path("t.tum"), "--force"} + options);
        if (told != nullptr)
            *told = r.err;
        const std::vector<Pose2D> found = posesOfTum(contentOf(path("t.tum")));
        double most = found.empty() ? INFINITY : 0, stamp = 0.1;
        const Pose2D first = drive_.at(stamp) * mount;
        for (const Pose2D &pose : found) {
            const Pose2D off =
                (first.inverse() * drive_.at(stamp) * mount).inverse() * (found[0].inverse() * pose);
            most = std::max(most, std::hypot(off.x, off.y));
            stamp += between_s;
        }
        return most;
    }

private Q_SLOTS:
    void aScannerIsNotWhatItIsSaidToBe_data() {
        const Rows<double, double, bool, QByteArray> row("secondsPerTurn", "turned", "isMirrored", "told");
        row("sound", 0, 0, false, "");
        row("bent", 0.1, 0, false, "a turn of the scanner takes 0.");
        row("bent, clockwise", -0.1, 0, false, "a turn of the scanner takes -0.");
        row("mirrored", 0, 0, true, "--mirrored");
        row("to the left", 0, pi / 2, false, "--sensor");
        row("to the right", 0, -0.6, false, "--sensor");
        row("backward", 0, pi, false, "--sensor");
    }
    void aScannerIsNotWhatItIsSaidToBe() {
        QFETCH(double, secondsPerTurn);
        QFETCH(double, turned);
        QFETCH(bool, isMirrored);
        QFETCH(QByteArray, told);
        const unsigned first = qEnvironmentVariableIsSet("HERMES_SEED") ? newSeed() : 1;
        const int asked = qEnvironmentVariableIntValue("HERMES_CASES"), cases = asked > 0 ? asked : 2;
        for (unsigned seed = first; seed < first + unsigned(cases); ++seed) {
            draw(seed);
            RingBuilding building(random_);
            std::vector<Pose2D> way = building.drive(1);
            way.resize(std::min<std::size_t>(way.size(), 80));
            drive_.follow(way, 8);
            const Pose2D mount{0, 0, turned};
            put(path("in.log"), log(building.world, secondsPerTurn, mount, isMirrored));
            QByteArray said;
            double wrong = farthest({}, mount, &said);
            qInfo("seed %u: %.0f degrees, %.1f s: %.3f m, %s", seed, fieldOfView_ * 180 / pi, drive_.end(),
                  wrong, said.constData());
            QVERIFY2(told.isEmpty() ? said.isEmpty() : said.contains(told), said.constData());
            const int at = std::max(said.indexOf("(--sensor "), said.indexOf("(--mirrored)"));
            if (at >= 0) // what it says is done
                wrong = farthest(
                    QString::fromUtf8(said.mid(at + 1, said.indexOf(')', at) - at - 1)).split(' '), mount);
            QVERIFY2(wrong < 0.3, QByteArray::number(wrong));
            if (at < 0)
                continue;
            // The same in a finished map, whether it is found there or not.
            ran({"map", path("in.log"), "--odometry", "ignore", "--out-map", path("m.csv"), "--force"});
            const Result localized = run({"map", path("in.log"), "--localize", path("m.csv")});
            QVERIFY2(localized.err.contains(told), localized.err.constData());
        }
    }
};
