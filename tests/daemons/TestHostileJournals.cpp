// Journals whose sums are right and whose numbers are not.
#include "JournalBytes.h"
#include "daemons/scanmatcher/DriveJournal.h"

using namespace hermes;
using namespace hermes::scanmatcher;
using journal::item;
using vectorlib::Pose2D;

class TestHostileJournals : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void hostileTablesAreRefused_data() {
        Rows<QByteArray, bool>("bytes", "isRead");
        const QByteArray first = firstItem();
        QTest::newRow("one scan") << first + item(Tables().content()) << true;
        const QByteArray two = Tables().addKey().addMotion().content();
        QTest::newRow("two scans and a motion") << first + item(two) << true;
        QTest::newRow("another mark") << firstItem("other-journal") + item(two) << false;
        QTest::newRow("another version") << firstItem(journal::mark, 2) + item(two) << false;
        QTest::newRow("no mark") << item(two, true) << false;
        QTest::newRow("the beginning twice") << first + first + item(two) << false;
        QTest::newRow("no scan after the beginning") << first << false;
        QTest::newRow("empty") << QByteArray() << false;
        QTest::newRow("a map") << QByteArray("id,x1,y1,x2,y2\n") << false;
        QTest::newRow("a length of 2^63") << QByteArray::fromHex("d9d9f782005b7fffffffffffffff00") << false;
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

    void hostileTablesAreRefused() {
        FETCH(QByteArray, bytes, bool, isRead);
        const auto read = readDriveJournal(bytes, "hostile.journal");
        QCOMPARE(read.ok(), isRead);
        if (!isRead) {
            VERIFY_STARTS(read.error().message, "hostile.journal: byte ");
            return;
        }
        QCOMPARE(read->leftOut, qint64(0));
        // Behind what is whole it is left out.
        const auto tail = readDriveJournal(bytes + item("hostile"), "tail");
        QVERIFY(tail.ok() && tail->leftOut > 0 && tail->drive.loops.scans() == read->drive.loops.scans());
    }

    // Of a table with a wrong number no row is read, however many the others say that there are.
    void wrongTablesTakeNoMemory() {
        const auto peak = [] { // of the address space; MB
            const QByteArray status = contentOf("/proc/self/status");
            return status.mid(status.indexOf("VmPeak:") + 7).simplified().split(' ').value(0).toDouble() /
                   1024;
        };
        Tables tables;
        tables.edges.assign(100000, -1);
        for (int i = 1; i < 3000; ++i)
            tables.scans.insert(tables.scans.end(), {0, 0, 0, 0, 0, 1, 99999});
        const QByteArray bytes = firstItem() + item(tables.content());
        const double before = peak();
        QVERIFY(!readDriveJournal(bytes, "hostile.journal"));
        QVERIFY2(peak() - before < 1000, saying("%1 MB", peak() - before));
    }

    // Each byte of a small journal, with a sum that is right; and each place where it may be cut.
    void anyByteMayBeWrong() {
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
    void aScanLiesBetweenItsKeyScans() {
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
};
