// A drive is written down and read again: whole, cut, damaged, hostile; disks that are full or gone.
#include "daemons/scanmatcher/DriveJournal.h"
#include "tests/support/FileSizeLimit.h"
#include "tests/vectorlib/RingBuilding.h"

#include <malloc.h>

using namespace hermes;
using namespace hermes::scanmatcher;
using vectorlib::MappedDrive;
using vectorlib::Pose2D;
using vectorlib::TrackedBy;
using vectorlib::Transformation2D;

static QString difference(const MappedDrive &a, const MappedDrive &b) {
    const vectorlib::LoopCloser &x = a.loops, &y = b.loops;
    if (x.scans() != y.scans() || x.keys().size() != y.keys().size() ||
        x.graph().constraints.size() != y.graph().constraints.size())
        return QString("%1 and %2 scans, %3 and %4 keys, %5 and %6 motions")
            .arg(x.scans())
            .arg(y.scans())
            .arg(x.keys().size())
            .arg(y.keys().size())
            .arg(x.graph().constraints.size())
            .arg(y.graph().constraints.size());
    double apart = 0;
    for (std::size_t i = 0; i < x.scans(); ++i) {
        const Pose2D p = x.pose(i), q = y.pose(i);
        apart = std::max({apart, std::abs(p.x - q.x), std::abs(p.y - q.y),
                          std::abs(std::remainder(p.theta - q.theta, 2 * vectorlib::pi))});
        if (a.edges()[i].size() != b.edges()[i].size())
            return QString("edges of scan %1").arg(i);
        if (a.own()[i] != b.own()[i])
            return QString("own edges of scan %1").arg(i);
        for (std::size_t e = 0; e < a.edges()[i].size(); ++e)
            apart = std::max(apart, 1e-4 * (a.edges()[i][e].sums.mean - b.edges()[i][e].sums.mean).norm());
    }
    for (std::size_t k = 0; k < x.keys().size(); ++k)
        if (x.keys()[k].points.size() != y.keys()[k].points.size() || x.keys()[k].scan != y.keys()[k].scan)
            return QString("key %1").arg(k);
    for (std::size_t i = 0; i < x.graph().constraints.size(); ++i) {
        const auto &c = x.graph().constraints[i], &d = y.graph().constraints[i];
        apart =
            std::max({apart, 1e-9 * (c.information - d.information).norm(), std::abs(c.weight - d.weight)});
        if (c.from != d.from || c.to != d.to || c.mayBeWrong != d.mayBeWrong)
            return QString("motion %1").arg(i);
    }
    return apart < 1e-9 ? QString() : QString("%1 apart").arg(apart);
}

class TestDriveJournal : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder = std::make_unique<QTemporaryDir>();
        random.seed(11);
        building = std::make_unique<RingBuilding>(random);
        way = building->drive(2);
        trust.assign(100000, 0.75);
        origin = {};
    }

    void whatWasWrittenIsThereAgain() {
        MappedDrive memory;
        vectorlib::MapEdge wall;
        wall.id = 3;
        wall.observations = 7;
        wall.segment = {{1, 2}, {3, 5}};
        wall.sums.n = 12;
        wall.sums.mean = {2, 3.5};
        memory.known.push_back(wall);
        DriveJournal journal(folder->path(), "drive.journal");
        const std::size_t parts[] = {0, 1, 2, 400, 401, way.size()};
        for (std::size_t i = 1; i < std::size(parts); ++i) {
            drive(memory, parts[i - 1], parts[i]);
            journal.corrected();
            journal.finish(memory, trust);
            QVERIFY2(journal.state().fault.isEmpty(), qPrintable(journal.state().fault));
            const RememberedDrive again = read();
            QCOMPARE(difference(memory, again.drive), QString());
            QCOMPARE(again.leftOut, qint64(0));
            QCOMPARE(again.trust, std::vector<double>(parts[i], 0.75));
            QCOMPARE(again.drive.known.size(), std::size_t(1));
            QCOMPARE(again.drive.known[0].segment.end().y, 5.0);
            QCOMPARE(again.drive.known[0].observations, std::int64_t(7));
        }
        QVERIFY(memory.loops.counts().closed > 50);
        QCOMPARE(read().drive.loops.counts().closed, memory.loops.counts().closed);
        QCOMPARE(journal.state().bytes, qint64(contentOf(journal.state().path).size()));
        double metres = 0;
        for (std::size_t i = 1; i < way.size(); ++i)
            metres += std::hypot(way[i].x - way[i - 1].x, way[i].y - way[i - 1].y);
        qInfo("%zu scans, %zu key scans, %.0f m: %lld bytes, %.0f a metre", memory.loops.scans(),
              memory.loops.keys().size(), metres, journal.state().bytes,
              double(journal.state().bytes) / metres);
    }

    void aDriveGoesOnAsIfItHadNotEnded() {
        MappedDrive memory;
        const std::size_t half = way.size() / 2, end = way.size();
        drive(memory, 0, half);
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        RememberedDrive again = read();
        const auto before = random;
        drive(memory, half, end, TrackedBy::Placed);
        random = before;
        drive(again.drive, half, end, TrackedBy::Placed);
        QCOMPARE(again.drive.loops.counts().tried, memory.loops.counts().tried);
        QCOMPARE(again.drive.loops.counts().closed, memory.loops.counts().closed);
        const Pose2D p = again.drive.loops.pose(end - 1), q = memory.loops.pose(end - 1);
        QVERIFY(std::hypot(p.x - q.x, p.y - q.y) < 1e-6);
    }

    // Its coordinates may be those of a country.
    void aDriveInUtmIsThereAgain() {
        origin = Transformation2D(5e5, 5.9e6, 0);
        MappedDrive memory;
        drive(memory, 0, 400);
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        QCOMPARE(difference(memory, read().drive), QString());
    }

    // By a third too little or too much at most, and the same once it is read again.
    void itsMemoryIsTold() {
        MappedDrive memory;
        drive(memory, 0, 10);
        const std::size_t before = mallinfo2().uordblks, told = memory.bytes();
        drive(memory, 10, way.size());
        const std::size_t grown = mallinfo2().uordblks - before;
        qInfo("%zu scans: %zu bytes are told, %zu taken", way.size(), memory.bytes(), told + grown);
        if (before > 0) // a sanitizer has a heap of its own
            QVERIFY(3 * memory.bytes() > 2 * (told + grown) && 2 * memory.bytes() < 3 * (told + grown));
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        const auto again = double(read().drive.bytes());
        QVERIFY(std::abs(again - double(memory.bytes())) < 0.05 * again);
    }

    // What is cut after any block, of 200 scans each, is a drive of its own.
    void aCutTailIsLeftOut() {
        const QByteArray bytes = written(450);
        const RememberedDrive all = read();
        QCOMPARE(all.drive.loops.scans(), std::size_t(450));
        std::size_t last = 0;
        std::set<std::size_t> scans;
        const auto next = [end = bytes.size() - 200](int cut) {
            return cut < 200 || cut >= end ? cut + 1 : std::min(cut + 20011, end);
        };
        for (int cut = 0; cut <= bytes.size(); cut = next(cut)) {
            const auto part = readDriveJournal(bytes.left(cut), "cut");
            if (!part) {
                QCOMPARE(last, std::size_t(0));
                QVERIFY(part.error().code == int(ErrorCode::InputOutput));
                continue;
            }
            QVERIFY(part->drive.loops.scans() >= last);
            last = part->drive.loops.scans();
            scans.insert(last);
            QVERIFY(part->leftOut < cut);
            QVERIFY(last < 450 || cut == bytes.size());
        }
        QCOMPARE(scans, (std::set<std::size_t>{200, 400, 450}));
        const auto more = readDriveJournal(bytes + QByteArray(1000, '\0'), "more");
        QCOMPARE(more->leftOut, qint64(1000));
        QCOMPARE(more->drive.loops.scans(), std::size_t(450));
    }

    void aFlippedBitEndsIt() {
        const QByteArray bytes = written(450);
        for (int trial = 0; trial < 100; ++trial) {
            QByteArray damaged = bytes;
            const int at = int(random() % unsigned(bytes.size()));
            damaged[at] = char(damaged[at] ^ (1 << (random() % 8)));
            const auto part = readDriveJournal(damaged, "damaged");
            if (part)
                QVERIFY2(part->leftOut >= bytes.size() - at && part->drive.loops.scans() < 450,
                         qPrintable(QString("byte %1").arg(at)));
        }
    }

    void noFileIsEverOverwritten() {
        MappedDrive memory;
        drive(memory, 0, 20);
        for (const char *name : {"drive.journal", "drive-2.journal", "drive-3.journal"}) {
            DriveJournal journal(folder->path(), "drive.journal");
            QVERIFY(!QFile::exists(folder->filePath(name)));
            journal.finish(memory, trust);
            QCOMPARE(journal.state().path, folder->filePath(name));
            QCOMPARE(read(name).drive.loops.scans(), std::size_t(20));
        }
        DriveJournal two(folder->path(), "drive.journal");
        two.finish(memory, trust);
        two.begin();
        two.finish(memory, trust);
        QCOMPARE(two.state().path, folder->filePath("drive-5.journal"));
        DriveJournal none(folder->path(), {});
        none.finish(memory, trust);
        QCOMPARE(QDir(folder->path()).entryList(QDir::Files).size(), 5);
    }

    void aFullDiskIsToldAndMadeUpFor() {
        MappedDrive memory;
        drive(memory, 0, 100);
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        const qint64 before = journal.state().bytes;
        std::optional<FileSizeLimit> disk(rlim_t(before + 1000));
        drive(memory, 100, 200);
        journal.finish(memory, trust);
        QVERIFY2(journal.state().fault.contains("cannot be written"), qPrintable(journal.state().fault));
        QCOMPARE(qint64(contentOf(journal.state().path).size()), before); // no half block
        QCOMPARE(journal.state().scans, quint64(100));
        disk.reset();
        journal.finish(memory, trust);
        QCOMPARE(journal.state().fault, QString());
        QCOMPARE(difference(memory, read().drive), QString());
        DriveJournal nowhere("/dev/null/folder", "drive.journal");
        nowhere.finish(memory, trust);
        QVERIFY2(nowhere.state().fault.contains("cannot be made"), qPrintable(nowhere.state().fault));
    }

    void aFileThatOthersTouchBeginsAnew_data() {
        const Rows<QString, QString> row("how", "told");
        row("removed", "removed", "was removed");
        row("moved", "moved", "was moved or changed");
        row("cut", "cut", "was moved or changed");
        row("added to", "added", "was moved or changed");
        row("another in its place", "replaced", "was removed");
    }

    void aFileThatOthersTouchBeginsAnew() {
        FETCH(QString, how, QString, told);
        MappedDrive memory;
        drive(memory, 0, 50);
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        const QString path = journal.state().path;
        QFile file(path);
        if (how == "moved")
            QVERIFY(QFile::rename(path, path + ".kept"));
        else if (how == "cut")
            QVERIFY(file.resize(100));
        else if (how == "added")
            QVERIFY(file.open(QIODevice::Append) && file.write("other") == 5);
        else
            QVERIFY(file.remove());
        if (how == "replaced")
            put(path, "other");
        file.close();
        const QByteArray theirs = contentOf(path);
        drive(memory, 50, 100);
        journal.finish(memory, trust);
        QVERIFY2(journal.state().fault.contains(told), qPrintable(journal.state().fault));
        QCOMPARE(contentOf(path), theirs);
        journal.finish(memory, trust);
        QCOMPARE(journal.state().fault, QString());
        const auto read = readDriveJournal(contentOf(journal.state().path), "drive.journal");
        QVERIFY(read.ok());
        QCOMPARE(difference(memory, read->drive), QString());
    }

    // Reading and the map made of it; HERMES_JOURNAL_SCANS: how many.
    void fast() {
        const int scans = std::max(1000, qEnvironmentVariableIntValue("HERMES_JOURNAL_SCANS"));
        const QByteArray bytes = written(std::size_t(scans));
        QElapsedTimer timer;
        timer.start();
        const auto all = readDriveJournal(bytes, "drive.journal");
        const double read_s = 1e-9 * double(timer.nsecsElapsed());
        QVERIFY(all.ok());
        vectorlib::MapBuilder builder;
        const auto poses = all->drive.loops.poses();
        all->drive.rebuild(builder, poses);
        const double map_s = 1e-9 * double(timer.nsecsElapsed()) - read_s;
        all->drive.review(builder.map, poses);
        const double all_s = 1e-9 * double(timer.nsecsElapsed());
        qInfo("%d scans, %zu key scans, %.1f MB: read in %.3f s, map made in %.3f s, reviewed in %.3f s",
              scans, all->drive.loops.keys().size(), 1e-6 * bytes.size(), read_s, map_s,
              all_s - read_s - map_s);
    }

private:
    // On wheels that turn a little too far; from the end of the way on it stands.
    void drive(MappedDrive &memory, std::size_t from, std::size_t to, TrackedBy first = TrackedBy::Map) {
        const ScanWorld::Scanner scanner{500, 1.99 * vectorlib::pi, 0.03, 5};
        for (std::size_t i = from; i < to; ++i) {
            const std::size_t last = way.size() - 1, at = std::min(i, last),
                              before = std::min(i ? i - 1 : 0, last);
            const auto points = building->world.scan(Transformation2D(way[at]), random, scanner);
            eyes.find(points, {});
            Transformation2D motion = Transformation2D(way[before]).inverse() * Transformation2D(way[at]);
            if (at != before)
                motion = motion * Transformation2D(0, 0, 0.0005);
            memory.add(points, eyes.edges(), i ? motion : origin * Transformation2D(way[0]),
                       i == from ? first : TrackedBy::Map, i % 400 == 7 ? 1 : MappedDrive::all);
            if (memory.loops.isDue())
                memory.loops.correct();
        }
    }

    RememberedDrive read(const QString &name = "drive.journal") const {
        auto result = readDriveJournal(contentOf(folder->filePath(name)), name);
        if (!result)
            qFatal("%s", qPrintable(result.error().message));
        return result.take();
    }

    QByteArray written(std::size_t scans) {
        MappedDrive memory;
        drive(memory, 0, scans);
        DriveJournal journal(folder->path(), "drive.journal");
        journal.finish(memory, trust);
        return contentOf(folder->filePath("drive.journal"));
    }

    std::unique_ptr<QTemporaryDir> folder;
    std::mt19937 random;
    std::unique_ptr<RingBuilding> building;
    std::vector<Pose2D> way;
    Transformation2D origin; ///< of the building, in the map
    std::vector<double> trust;
    vectorlib::MapBuilder eyes;
};

QTEST_GUILESS_MAIN(TestDriveJournal)
#include "TestDriveJournal.moc"
