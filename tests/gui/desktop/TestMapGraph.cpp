#include "tests/gui/desktop/EightSession.h"

using namespace hermes;

Q_DECLARE_METATYPE(hermes::GraphMessage)

/// The graph of the drive as it comes, is shown and is asked for.
class TestMapGraph : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void graphComesInParts() {
        EightSession s(false);
        s.daemon.say("graph", s.bent.graph(7, true, 0, 50, lastKeyScan + 1, ""));
        s.daemon.say("graph", s.bent.graph(7, false, 50, 100, lastKeyScan + 1, ""));
        s.daemon.say("graph", s.bent.graph(7, false, 100, lastKeyScan + 1, lastKeyScan + 1, twoLoops));
        QTRY_COMPARE(s.model.graph().size(), lastKeyScan + 1);
        for (int i = 0; i <= lastKeyScan; ++i)
            QVERIFY(EightSession::isAt(s.model.graph().poses[i], s.bent.pose(i)));
        QCOMPARE(s.model.graph().loops.size(), 2);
        QCOMPARE(s.model.graph().trust[60], 1 - 0.9 * 60 / EightDrive::keyScans);
        QVERIFY(!s.model.correction_m());
        QCOMPARE(s.model.ignored(), quint64(0));
    }

    void layersAreSwitched() {
        EightSession s;
        s.view.fit();
        for (const char *const name : {"Loops", "Graph", "Trust"}) {
            QAction *layer = nullptr;
            for (QAction *const action : s.panel.findChild<QMenu *>("layers")->actions())
                if (action->text().startsWith(name))
                    layer = action;
            QVERIFY2(layer, name);
            QCOMPARE(layer->isChecked(), QByteArray(name) == "Loops");
            const QImage before = s.view.grab().toImage();
            layer->toggle();
            QVERIFY2(s.view.grab().toImage() != before, name);
            layer->toggle();
            QVERIFY2(s.view.grab().toImage() == before, name);
        }
        QByteArray drawn = s.svg();
        QVERIFY(drawn.contains("stroke-dasharray")); // the refused loop
    }

    void trustAndNoticeAreWritten() {
        EightSession s;
        QVERIFY(s.model.trust() && *s.model.trust() == 0.87);
        QVERIFY(s.svg().contains("trust of the pose 0.87"));
        QVERIFY(!s.svg().contains("map corrected"));
        for (const char what : {'p', 'g', 'm'})
            s.sayCorrected(what);
        QTRY_VERIFY(s.model.correction_m());
        const double farthest = *s.model.correction_m();
        QVERIFY(s.svg().contains("map corrected: " + QByteArray::number(farthest, 'f', 2) + " m"));
        QTRY_VERIFY_WITH_TIMEOUT(!s.model.correction_m(), 10000);
        QVERIFY(!s.svg().contains("map corrected"));
        s.daemon.say("pose", R"({"x":0,"y":0,"theta":0,"covariance":null,"outcome":"matched","trust":7})");
        QTRY_VERIFY(!s.model.trust());
        QCOMPARE(s.model.ignored(), quint64(1));
    }

    void graphWithoutSense_data() {
        Rows<std::vector<GraphMessage>, int, int, int, bool>("messages", "ignored", "size", "loops",
                                                             "isNext"); // isNext: after the lastKeyScan
        const double nan = std::nan(""), huge = 1e300;
        using Messages = std::vector<GraphMessage>;
        const GraphMessage good{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1, 1}, {{0, 1, 1}}, 2};
        const auto row = [](const char *name, const Messages &messages, int ignored, int size, int loops,
                            bool isNext = true) {
            QTest::newRow(name) << messages << ignored << size << loops << isNext;
        };
        const std::vector<std::array<double, 3>> many(1000000);
        row("good", {good}, 0, 2, 1);
        row("NaN", {{1, true, 0, {{0, 0, 0}, {nan, 0, 0}, {0, 0, nan}}, {1, nan, 1}, {{0, 1, nan}}, 3}}, 4, 3,
            0);
        row("huge", {{1, true, 0, {{huge, 0, 0}, {0, -huge, 0}}, {huge, -huge}, {{0, 1, huge}}, 2}}, 5, 2, 0);
        row("trust is missing", {{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1}, {}, 2}}, 1, 2, 0);
        row("loops to nowhere", {good, {2, false, 2, {}, {}, {{0, 2, 1}, {-1, 0, 1}, {0, 1LL << 62, 1}}, 2}},
            3, 2, 1);
        row("first beyond size", {good, {2, false, 9, {{0, 0, 0}}, {1}, {}, 5}}, 2, 2, 1);
        row("more than size", {{1, true, 0, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {1, 1, 1}, {}, 2}}, 1, 2, 0);
        row("first is negative", {good, {2, false, -1, {{0, 0, 0}}, {1}, {}, 2}}, 2, 2, 1);
        row("size is negative", {good, {2, false, 0, {{0, 0, 0}}, {1}, {}, -5}}, 2, 2, 1);
        row("key scan again", {good, {2, false, 1, {{1, 2, 0}}, {1}, {}, 2}}, 0, 2, 1);
        row("cleared amid parts", {{1, true, 0, {{0, 0, 0}}, {1}, {}, 9}, good}, 0, 2, 1);
        row("a revision is missed", {good, {3, false, 2, {{0, 0, 0}}, {1}, {}, 3}}, 0, 2, 1, false);
        row("a part is missed", {good, {2, false, 5, {{0, 0, 0}}, {1}, {}, 6}}, 0, 2, 1, false);
        row("waits for the whole",
            {good, {3, false, 2, {}, {}, {}, 3}, {4, false, 2, {{0, 0, 0}}, {1}, {}, 3}}, 0, 2, 1);
        row("the whole comes", {good, {3, false, 2, {}, {}, {}, 3}, good}, 0, 2, 1);
        row("a million key scans",
            {{1, true, 0, many, std::vector<double>(many.size(), 1), {}, 1000000},
             {2, false, 1000000, {{0, 0, 0}}, {1}, {}, 1000001}},
            1000000 - KeyScanGraph::maxKeyScans + 1, KeyScanGraph::maxKeyScans, 0);
        row("a million loops",
            {{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1, 1}, std::vector<GraphLoop>(1000000, {0, 1, 1}), 2}},
            1000000 - KeyScanGraph::maxLoops, 2, KeyScanGraph::maxLoops);
    }

    void graphWithoutSense() {
        FETCH(std::vector<GraphMessage>, messages, int, ignored, int, size, int, loops, bool, isNext);
        KeyScanGraph graph;
        quint64 passedOver = 0;
        for (std::size_t i = 0; i < messages.size(); ++i) {
            const bool wasNext = graph.take(messages[i]);
            passedOver += graph.takeIgnored();
            if (i + 1 == messages.size())
                QCOMPARE(wasNext, isNext);
        }
        QCOMPARE(passedOver, quint64(ignored));
        QCOMPARE(graph.known().size(), size);
        QCOMPARE(graph.known().trust.size(), size);
        QCOMPARE(graph.known().loops.size(), loops);
        for (const Pose2D &pose : graph.known().poses)
            QVERIFY(std::abs(pose.x) < 1e6 && std::abs(pose.y) < 1e6 && std::abs(pose.theta) < 1e6);
    }

    void lostRevisionIsAskedFor() {
        EightSession s;
        s.daemon.say("graph",
                     s.bent.graph(500, false, lastKeyScan + 1, lastKeyScan + 2, lastKeyScan + 2, ""));
        QTRY_VERIFY(s.daemon.subscriptions("graph") == 2);
        QCOMPARE(s.model.graph().size(), lastKeyScan + 1);
        s.daemon.say("graph", s.bent.graph(500, true, 0, lastKeyScan + 2, lastKeyScan + 2, ""));
        QTRY_COMPARE(s.model.graph().size(), lastKeyScan + 2);
        QVERIFY(!s.model.correction_m());
    }
};
