#include <vectorlib/graph/DriveParts.h>
#include <vectorlib/graph/DriveRefiner.h>
#include <vectorlib/mapping/ScanTracker.h>

#include "tests/vectorlib/OfficeFloor.h"
#include "tests/vectorlib/RevisitError.h"

using namespace vectorlib;

/// Drives whose way is not known in between.
class TestDriveParts : public QObject {
    Q_OBJECT

    enum class Carried { Nowhere, OnTheFloor, ToAnotherFloor };

    /// A drive through a floor; in its middle the robot may be carried, of which its slipping wheels know
    /// nothing.
    struct Drive {
        static constexpr std::size_t before = 500, behind = 400, carriedPast = 150;

        std::vector<Pose2D> way, poses;
        std::vector<DrivePart> parts;

        Drive(unsigned seed, Carried carried) {
            std::mt19937 random(seed);
            OfficeFloor floor({50, 35}, random), other({50, 35}, random);
            way = floor.drive(before + carriedPast + behind, step);
            if (carried == Carried::OnTheFloor)
                way.erase(way.begin() + before, way.begin() + before + carriedPast);
            else
                way.resize(before + behind);
            const std::vector<Pose2D> otherWay = other.drive(behind, step);
            if (carried == Carried::ToAnotherFloor)
                std::copy(otherWay.begin(), otherWay.end(), way.begin() + before);
            std::normal_distribution<double> noise;
            tracker.place(way[0]);
            for (std::size_t i = 0; i < way.size(); ++i) {
                if (i > 0 && (i != before || carried == Carried::Nowhere)) {
                    const Transformation2D m = between(way[i - 1], way[i]);
                    const double slip = 1 + 0.03 * noise(random);
                    wheels = wheels * Transformation2D(m.x() * slip, m.y() * slip, m.alpha());
                }
                const bool isThere = i >= before && carried == Carried::ToAnotherFloor;
                take((isThere ? other : floor).scan(Transformation2D(way[i]), scanner));
            }
            drive.loops.correct();
            poses = drive.loops.poses();
            parts = DriveParts()(drive, poses);
            refine(poses, drive.loopsOfScans());
        }

    private:
        static constexpr double step = 0.4;
        static constexpr ScanWorld::Scanner scanner{361, 1.5 * pi, 0.02, 20};

        void take(ScanWorld::Points points) {
            TimedScan scan =
                timedScan(std::move(points), scanner, 0.3 * double(drive.loops.scans()), wheels.pose());
            const Transformation2D pose(tracker.process(scan).pose);
            const Transformation2D motion = drive.loops.scans() > 0 ? last.inverse() * pose : pose;
            last = pose;
            drive.add(scan.points, tracker.builder.edges(), motion, tracker.trackedBy());
            refine.add(scan.points, motion);
            if (drive.loops.isDue())
                drive.loops.correct();
        }

        ScanTracker tracker;
        MappedDrive drive;
        DriveRefiner refine;
        Transformation2D wheels, last;
    };

    static QByteArray told(const Drive &d) {
        QByteArray text = QByteArray::number(revisitError(d.way, d.poses, 7), 'f', 3) + " m at revisits:";
        for (const DrivePart &part : d.parts)
            text += " from " + QByteArray::number(int(part.begin)) + (part.isJoined ? "" : " (beside)");
        return text;
    }
    static unsigned drawnSeed() { return newSeed(); }
    // A drive takes 20 s under sanitizers, which look for errors only.
    static unsigned fewer(unsigned drives) { return slowness > 1 ? 1 : drives; }
    // Those in which the place where the robot was put down looks different, and some that are drawn.
    static void addDrives(std::initializer_list<unsigned> noticed) {
        const Rows<unsigned, bool> row("seed", "isNoticed");
        const auto add = [&](unsigned seed, bool isNoticed) {
            row(qPrintable(QString::number(seed)), seed, isNoticed);
        };
        std::for_each(noticed.begin(), noticed.begin() + fewer(unsigned(noticed.size())),
                      [&](unsigned seed) { add(seed, true); });
        const unsigned drawn = drawnSeed(), drives = fewer(4);
        for (unsigned i = 0; i < drives; ++i)
            add(drawn + i, false);
    }
    // One or two drawn drives of a hundred do (docs/mapping.md), and of those that nobody carried one of
    // some hundreds (seed 570343371): one of those here.
    bool mayFail(bool isNoticed) { return !isNoticed && ++failed_ <= 1; }
    int failed_ = 0;
    static double leastX(const Drive &d, const DrivePart &part) {
        double least = 1e9;
        for (std::size_t i = part.begin; i < part.end; ++i)
            least = std::min(least, d.poses[i].x);
        return least;
    }

private Q_SLOTS:
    void aKnownWayIsOnePart() {
        const unsigned seed = drawnSeed(), drives = fewer(3);
        for (unsigned i = 0; i < drives; ++i) {
            const Drive d(seed + i, Carried::Nowhere);
            qInfo("seed %u: %s", seed + i, told(d).constData());
            QCOMPARE(d.parts.size(), std::size_t(1));
            QVERIFY(d.parts[0].isJoined && d.parts[0].end == d.way.size());
            QVERIFY(revisitError(d.way, d.poses, 7) < 0.05 || mayFail(false));
        }
    }

    void carriedRobotComesBack_data() { addDrives({0, 1, 4, 6}); }
    void carriedRobotComesBack() {
        FETCH(unsigned, seed, bool, isNoticed);
        const Drive d(seed, Carried::OnTheFloor);
        qInfo("%s", told(d).constData());
        const bool isWhole =
            std::all_of(d.parts.begin(), d.parts.end(), [](const DrivePart &p) { return p.isJoined; });
        if (isNoticed)
            QVERIFY(d.parts.size() > 1 && isWhole);
        const bool isWrong = d.parts.size() > 1 && isWhole && revisitError(d.way, d.poses, 7) >= 0.3;
        QVERIFY(!isWrong || mayFail(isNoticed));
        QCOMPARE(d.parts.back().end, d.way.size());
    }

    void whatIsFoundNowhereIsLaidBeside_data() { addDrives({5, 6, 9}); }
    void whatIsFoundNowhereIsLaidBeside() {
        FETCH(unsigned, seed, bool, isNoticed);
        const Drive d(seed, Carried::ToAnotherFloor);
        qInfo("%s", told(d).constData());
        if (isNoticed)
            QVERIFY(d.parts.size() > 1);
        double most = -1e9; // x of what is joined
        for (const DrivePart &part : d.parts)
            for (std::size_t i = part.begin; part.isJoined && i < part.end; ++i)
                most = std::max(most, d.poses[i].x);
        for (const DrivePart &part : d.parts) {
            const bool isOther = part.begin + 10 >= Drive::before;
            if (d.parts.size() > 1 && isOther && part.end - part.begin > 100)
                QVERIFY(!part.isJoined || mayFail(isNoticed));
            if (!part.isJoined)
                QVERIFY(leastX(d, part) > most);
        }
    }
};
