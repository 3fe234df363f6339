// A drive is written down and read again: whole, cut, damaged, hostile; disks that are full or gone.
#include "daemons/scanmatcher/DriveJournal.h"
#include "daemons/scanmatcher/JournalTables.h"
#include "protocol/serial/Crc32c.h"
#include "tests/vectorlib/RingBuilding.h"

#include <QCborStreamWriter>
#include <QTemporaryDir>
#include <QtTest>

#include <csignal>
#include <malloc.h>
#include <set>
#include <sys/resource.h>

using namespace hermes;
using namespace hermes::scanmatcher;
using vectorlib::MappedDrive;
using vectorlib::Pose2D;
using vectorlib::TrackedBy;
using vectorlib::Transformation2D;

namespace {

QByteArray contentOf(const QString &path) {
    QFile file(path);
    return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

/// One item of a journal that is whole by its sum.
QByteArray item(const QByteArray &content, bool isFirst = false) {
    QByteArray bytes;
    QCborStreamWriter out(&bytes);
    if (isFirst)
        out.append(QCborTag(journal::cbor));
    out.startArray(2);
    out.append(quint64(crc32c(content.constData(), std::size_t(content.size()))));
    out.append(content);
    out.endArray();
    return bytes;
}

/// The numbers of a block's tables; of a drive of one scan that saw one wall.
struct Tables {
    std::vector<double> scans{0, 0, 0, 0, 0, 0.5, 1}, keys{0, 1, 2, 0.5, 0, 0, 0, 1, 2, 0.5, 0, 0, 2};
    std::vector<double> motions, poses{1, 2, 0.5}, weights, since{0, 0, 0, 0, 0, 0, 0, 0};
    std::vector<double> progress{0, 0, 0, 0, 1};
    std::vector<float> edges{9, 1, 1, 3, 0, 0, 0, 1, 2, 1, 0.01F}, points{0, 1, 2, 1};

    /// Another scan, a key scan with no points.
    Tables &addKey() {
        scans.insert(scans.end(), {1, 0, 0, 0, 0, 1, 0});
        keys.insert(keys.end(), {1, 1, 0, 0, 1, 0.1, 0.1, 2, 2, 0.5, 1, 0.1, 0});
        poses.insert(poses.end(), {2, 2, 0.5});
        return *this;
    }
    Tables &addMotion() {
        motions = {0, 1, 1, 0, 0, 100, 0, 0, 100, 0, 100, 0, 1};
        weights = {1};
        return *this;
    }
    QByteArray content() const {
        QByteArray bytes;
        QCborStreamWriter out(&bytes);
        out.startMap();
        put(out, journal::scans, scans);
        put(out, journal::edges, edges);
        put(out, journal::keys, keys);
        put(out, journal::points, points);
        put(out, journal::motions, motions);
        put(out, journal::poses, poses);
        put(out, journal::weights, weights);
        put(out, journal::since, since);
        put(out, journal::progress, progress);
        out.endMap();
        return bytes;
    }

private:
    template <typename T>
    static void put(QCborStreamWriter &out, const journal::Table &table, const std::vector<T> &numbers) {
        out.append(QLatin1String(table.name));
        out.append(QCborTag(sizeof(T) == 4 ? journal::floats : journal::doubles));
        out.appendByteString(reinterpret_cast<const char *>(numbers.data()),
                             qsizetype(numbers.size() * sizeof(T)));
    }
};

/// The item with which a journal begins.
QByteArray firstItem(const char *mark = journal::mark, quint64 version = journal::version) {
    QByteArray begin;
    QCborStreamWriter out(&begin);
    out.startMap();
    out.append(QLatin1String(mark));
    out.append(version);
    out.endMap();
    return item(begin, true);
}

QString difference(const MappedDrive &a, const MappedDrive &b) {
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

} // namespace

class TestDriveJournal : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void whatWasWrittenIsThereAgain();
    void aDriveGoesOnAsIfItHadNotEnded();
    void itsMemoryIsTold();
    void blocksFollowEachOther();
    void aCutTailIsLeftOut();
    void aFlippedBitEndsIt();
    void hostileNumbersAreRefused();
    void hostileTablesAreRefused_data();
    void hostileTablesAreRefused();
    void anyByteMayBeWrong();
    void aScanLiesBetweenItsKeyScans();
    void noFileIsEverOverwritten();
    void aFullDiskIsToldAndMadeUpFor();
    void aRemovedFileBeginsAnew();
    void fast();

private:
    void drive(MappedDrive &memory, std::size_t from, std::size_t to, TrackedBy first = TrackedBy::Map);
    RememberedDrive read(const QString &name = "drive.journal") const {
        auto result = readDriveJournal(contentOf(folder->filePath(name)), name);
        if (!result)
            qFatal("%s", qPrintable(result.error().message));
        return result.take();
    }
    QByteArray written(std::size_t scans);

    std::unique_ptr<QTemporaryDir> folder;
    std::mt19937 random;
    std::unique_ptr<RingBuilding> building;
    std::vector<Pose2D> way;
    std::vector<double> trust;
    vectorlib::MapBuilder eyes;
};

void TestDriveJournal::init() {
    folder = std::make_unique<QTemporaryDir>();
    random.seed(11);
    building = std::make_unique<RingBuilding>(random);
    way = building->drive(2);
    trust.assign(100000, 0.75);
}

// On wheels that turn a little too far; from the end of the way on it stands.
void TestDriveJournal::drive(MappedDrive &memory, std::size_t from, std::size_t to, TrackedBy first) {
    const ScanWorld::Scanner scanner{500, 1.99 * vectorlib::pi, 0.03, 5};
    for (std::size_t i = from; i < to; ++i) {
        const std::size_t last = way.size() - 1, at = std::min(i, last),
                          before = std::min(i ? i - 1 : 0, last);
        const auto points = building->world.scan(Transformation2D(way[at]), random, scanner);
        eyes.find(points, {});
        Transformation2D motion = Transformation2D(way[before]).inverse() * Transformation2D(way[at]);
        if (at != before)
            motion = motion * Transformation2D(0, 0, 0.0005);
        memory.add(points, eyes.edges(), i ? motion : Transformation2D(way[0]),
                   i == from ? first : TrackedBy::Map);
        if (memory.loops.isDue())
            memory.loops.correct();
    }
}

QByteArray TestDriveJournal::written(std::size_t scans) {
    MappedDrive memory;
    drive(memory, 0, scans);
    DriveJournal journal(folder->path(), "drive.journal");
    journal.finish(memory, trust);
    return contentOf(folder->filePath("drive.journal"));
}

void TestDriveJournal::whatWasWrittenIsThereAgain() {
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
          memory.loops.keys().size(), metres, journal.state().bytes, double(journal.state().bytes) / metres);
}

void TestDriveJournal::aDriveGoesOnAsIfItHadNotEnded() {
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

// By a third too little or too much at most, and the same once it is read again.
void TestDriveJournal::itsMemoryIsTold() {
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

// What is cut after any block is a drive of its own.
void TestDriveJournal::blocksFollowEachOther() {
    MappedDrive memory;
    drive(memory, 0, 1250);
    DriveJournal journal(folder->path(), "drive.journal");
    journal.finish(memory, trust);
    const QByteArray bytes = contentOf(folder->filePath("drive.journal"));
    std::set<std::size_t> scans;
    for (int cut = 0; cut < bytes.size(); cut += 19997)
        if (const auto part = readDriveJournal(bytes.left(cut), "cut"))
            scans.insert(part->drive.loops.scans());
    QVERIFY(scans.size() >= 6); // of 200 each
    for (const std::size_t count : scans)
        QVERIFY(count % 200 == 0 || count == 1250);
}

void TestDriveJournal::aCutTailIsLeftOut() {
    const QByteArray bytes = written(450);
    const RememberedDrive all = read();
    QCOMPARE(all.drive.loops.scans(), std::size_t(450));
    std::size_t last = 0;
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
        QVERIFY(part->leftOut < cut);
        QVERIFY(last < 450 || cut == bytes.size());
    }
    QCOMPARE(last, std::size_t(450));
    const auto more = readDriveJournal(bytes + QByteArray(1000, '\0'), "more");
    QCOMPARE(more->leftOut, qint64(1000));
    QCOMPARE(more->drive.loops.scans(), std::size_t(450));
}

void TestDriveJournal::aFlippedBitEndsIt() {
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

// Their sums are right: the numbers alone are wrong.
void TestDriveJournal::hostileNumbersAreRefused() {
    MappedDrive memory;
    drive(memory, 0, 60);
    DriveJournal journal(folder->path(), "drive.journal");
    journal.finish(memory, trust);
    const QByteArray bytes = contentOf(folder->filePath("drive.journal"));
    const QByteArray first = firstItem();
    QVERIFY(bytes.startsWith(first));
    QByteArray content = bytes.mid(first.size() + 1 + 5); // array, sum
    content = content.mid(content.size() > 65535 ? 5 : 3);
    QVERIFY(readDriveJournal(first + item(content), "same").ok());
    const double wrong[] = {std::nan(""), HUGE_VAL, -1, 1e300, 1e9, 0.5};
    int refused = 0, taken = 0;
    for (int at = 0; at + 8 < content.size(); at += content.size() / 600 + 1) {
        QByteArray hostile = content;
        const double value = wrong[random() % std::size(wrong)];
        std::memcpy(hostile.data() + at, &value, at % 2 ? 8 : 4);
        const auto read = readDriveJournal(first + item(hostile), "hostile");
        refused += !read;
        taken += read.ok();
        if (!read)
            continue;
        QVERIFY(read->drive.loops.scans() <= 60);
        for (const Pose2D &p : read->drive.loops.poses())
            QVERIFY(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta));
        for (const auto &c : read->drive.loops.graph().constraints)
            QVERIFY(c.from < 60 && c.to < 60 && c.information.allFinite());
    }
    QVERIFY2(refused > 20 && taken > 20, qPrintable(QString("%1 %2").arg(refused).arg(taken)));
    QVERIFY(!readDriveJournal(first, "nothing"));
    QVERIFY(!readDriveJournal("id,x1,y1,x2,y2\n", "a map"));
    QVERIFY(!readDriveJournal({}, "empty"));
    QVERIFY(!readDriveJournal(QByteArray::fromHex("d9d9f782005b7fffffffffffffff00"), "long"));
}

void TestDriveJournal::hostileTablesAreRefused_data() {
    QTest::addColumn<QByteArray>("bytes");
    QTest::addColumn<bool>("isRead");
    const QByteArray first = firstItem();
    QTest::newRow("one scan") << first + item(Tables().content()) << true;
    const QByteArray two = Tables().addKey().addMotion().content();
    QTest::newRow("two scans and a motion") << first + item(two) << true;
    QTest::newRow("another mark") << firstItem("other-journal") + item(two) << false;
    QTest::newRow("another version") << firstItem(journal::mark, 2) + item(two) << false;
    QTest::newRow("no mark") << item(two, true) << false;
    QTest::newRow("the beginning twice") << first + first + item(two) << false;
    QTest::newRow("not tagged") << item(two) + item(two) << false;
    const auto row = [&](const QByteArray &name, const std::function<void(Tables &)> &spoil) {
        Tables tables = Tables().addKey().addMotion();
        spoil(tables);
        QTest::newRow(name.constData()) << first + item(tables.content()) << false;
    };
    const double nan = std::nan("");
    row("half a row", [](Tables &t) { t.scans.pop_back(); });
    row("no scan", [](Tables &t) { t.scans.clear(); });
    row("no key scan", [](Tables &t) { t.keys.clear(); });
    row("no pose", [](Tables &t) { t.poses.clear(); });
    row("a pose too many", [](Tables &t) { t.poses.insert(t.poses.end(), {0, 0, 0}); });
    row("a weight too many", [](Tables &t) { t.weights = {1, 1}; });
    row("two rows of progress", [](Tables &t) { t.progress.insert(t.progress.end(), {0, 0, 0, 0, 0}); });
    row("a scan of a key scan to come", [](Tables &t) { t.scans[0] = 1; });
    row("a key scan of no scan", [](Tables &t) { t.keys[13] = 7; });
    row("edges of 1e9", [](Tables &t) { t.scans[6] = 1e9; });
    row("edges of -1", [](Tables &t) { t.scans[6] = -1; });
    row("half an edge", [](Tables &t) { t.scans[6] = 0.5; });
    row("an edge of no scan", [](Tables &t) { t.scans[6] = 0; });
    row("points of 1e15", [](Tables &t) { t.keys[12] = 1e15; });
    row("points of no key scan", [](Tables &t) { t.keys[12] = 1; });
    row("a motion to itself", [](Tables &t) { t.motions[1] = 0; });
    row("a motion to nowhere", [](Tables &t) { t.motions[1] = 2; });
    row("a motion to -1", [](Tables &t) { t.motions[1] = -1; });
    row("information below 0", [](Tables &t) { t.motions[5] = -100; });
    row("information of none", [](Tables &t) { t.motions[5] = t.motions[8] = t.motions[10] = 0; });
    row("a weight of 2", [](Tables &t) { t.weights[0] = 2; });
    row("trust of 2", [](Tables &t) { t.scans[5] = 2; });
    row("a wall without points", [](Tables &t) { t.edges[0] = 0; });
    row("a variance below 0", [](Tables &t) { t.keys[5] = -1; });
    row("corrected later than now", [](Tables &t) { t.progress[4] = 3; });
    for (const double wrong : {nan, HUGE_VAL, -HUGE_VAL, 1e300}) {
        const QByteArray name = QByteArray::number(wrong);
        row("pose " + name, [&](Tables &t) { t.poses[0] = wrong; });
        row("motion " + name, [&](Tables &t) { t.scans[1] = wrong; });
        row("tracked " + name, [&](Tables &t) { t.keys[7] = wrong; });
        row("loop " + name, [&](Tables &t) { t.motions[3] = wrong; });
        row("information " + name, [&](Tables &t) { t.motions[6] = wrong; });
        row("weight " + name, [&](Tables &t) { t.weights[0] = wrong; });
        row("since " + name, [&](Tables &t) { t.since[4] = wrong; });
        row("wall " + name, [&](Tables &t) { t.edges[6] = float(wrong); });
        row("point " + name, [&](Tables &t) { t.points[1] = float(wrong); });
    }
}

void TestDriveJournal::hostileTablesAreRefused() {
    QFETCH(QByteArray, bytes);
    QFETCH(bool, isRead);
    const auto read = readDriveJournal(bytes, "hostile.journal");
    QCOMPARE(read.ok(), isRead);
    if (!isRead) {
        QVERIFY2(read.error().message.startsWith("hostile.journal: byte "), qPrintable(read.error().message));
        return;
    }
    QCOMPARE(read->leftOut, qint64(0));
    // Behind what is whole it is left out.
    const auto tail = readDriveJournal(bytes + item("hostile"), "tail");
    QVERIFY(tail.ok() && tail->leftOut > 0 && tail->drive.loops.scans() == read->drive.loops.scans());
}

// Each byte of a small journal, with a sum that is right; and each place where it may be cut.
void TestDriveJournal::anyByteMayBeWrong() {
    const QByteArray content = Tables().addKey().addMotion().content(), first = firstItem();
    const QByteArray bytes = first + item(content);
    for (int cut = 0; cut < bytes.size(); ++cut)
        QVERIFY(!readDriveJournal(bytes.left(cut), "cut"));
    int taken = 0;
    for (int at = 0; at < content.size(); ++at)
        for (const int wrong : {0x00, 0x01, 0x3f, 0x7f, 0x80, 0x9f, 0xbf, 0xff}) {
            QByteArray hostile = content;
            hostile[at] = char(wrong);
            auto read = readDriveJournal(first + item(hostile), "hostile");
            if (!read)
                continue;
            ++taken;
            QVERIFY(read->drive.loops.scans() <= 2);
            read->drive.loops.correct();
            vectorlib::MapBuilder builder;
            read->drive.rebuild(builder);
            for (const Pose2D &p : read->drive.loops.poses())
                QVERIFY(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.theta));
        }
    QVERIFY(taken > 100);
}

// However much of the way between them it says that it is.
void TestDriveJournal::aScanLiesBetweenItsKeyScans() {
    Tables tables;
    tables.scans.insert(tables.scans.end(), {0, 0.4, 0, 0, 1e15, 1, 0});
    tables.addKey();
    tables.keys[13] = 2;
    tables.keys[17] = 5e-324; // its effort
    tables.scans[14] = 1;
    tables.poses[3] = 3; // a metre farther than it was tracked
    const auto read = readDriveJournal(firstItem() + item(tables.content()), "between");
    QVERIFY2(read.ok(), qPrintable(read ? QString() : read.error().message));
    const Pose2D p = read->drive.loops.pose(1);
    QVERIFY(std::hypot(p.x - 2, p.y - 2) < 2);
}

void TestDriveJournal::noFileIsEverOverwritten() {
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

void TestDriveJournal::aFullDiskIsToldAndMadeUpFor() {
    MappedDrive memory;
    drive(memory, 0, 100);
    DriveJournal journal(folder->path(), "drive.journal");
    journal.finish(memory, trust);
    const qint64 before = journal.state().bytes;
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    rlimit small = old;
    small.rlim_cur = rlim_t(before + 1000);
    ::setrlimit(RLIMIT_FSIZE, &small);
    const auto release = qScopeGuard([&] { ::setrlimit(RLIMIT_FSIZE, &old); });
    drive(memory, 100, 200);
    journal.finish(memory, trust);
    QVERIFY2(journal.state().fault.contains("cannot be written"), qPrintable(journal.state().fault));
    QCOMPARE(qint64(contentOf(journal.state().path).size()), before); // no half block
    QCOMPARE(journal.state().scans, quint64(100));
    ::setrlimit(RLIMIT_FSIZE, &old);
    journal.finish(memory, trust);
    QCOMPARE(journal.state().fault, QString());
    QCOMPARE(difference(memory, read().drive), QString());
    DriveJournal nowhere("/dev/null/folder", "drive.journal");
    nowhere.finish(memory, trust);
    QVERIFY2(nowhere.state().fault.contains("cannot be made"), qPrintable(nowhere.state().fault));
}

void TestDriveJournal::aRemovedFileBeginsAnew() {
    MappedDrive memory;
    drive(memory, 0, 50);
    DriveJournal journal(folder->path(), "drive.journal");
    journal.finish(memory, trust);
    QVERIFY(QFile::remove(journal.state().path));
    drive(memory, 50, 100);
    journal.finish(memory, trust);
    QVERIFY(journal.state().fault.contains("removed"));
    journal.finish(memory, trust);
    QCOMPARE(journal.state().fault, QString());
    QCOMPARE(difference(memory, read().drive), QString());
}

// Reading and the map made of it; HERMES_JOURNAL_SCANS: how many.
void TestDriveJournal::fast() {
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
    qInfo("%d scans, %zu key scans, %.1f MB: read in %.3f s, map made in %.3f s, reviewed in %.3f s", scans,
          all->drive.loops.keys().size(), 1e-6 * bytes.size(), read_s, map_s, all_s - read_s - map_s);
}

QTEST_GUILESS_MAIN(TestDriveJournal)
#include "TestDriveJournal.moc"
