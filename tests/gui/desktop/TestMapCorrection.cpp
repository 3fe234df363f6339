#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/view/Clipping.h"
#include "tests/gui/desktop/EightDrive.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/support/Patience.h"

#include <QAction>
#include <QFile>
#include <QMenu>
#include <QtTest>

using namespace hermes;
using namespace hermes::desktop;

Q_DECLARE_METATYPE(hermes::GraphMessage)

/// The graph of the drive, and a map that is corrected while the operator looks at it.
class TestMapCorrection : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void graphComesInParts();
    void correctionGlides_data();
    void correctionGlides();
    void viewThatFollowsDoesNotLeap();
    void fittedViewShowsWhatGrows();
    void correctedAgainWhileItGlides();
    void correctionOfWhichNotAllComes_data();
    void correctionOfWhichNotAllComes();
    void partsThatComeSlowly();
    void largeMapIsNotAnimated();
    void clearedMapIsNoCorrection();
    void layersAreSwitched();
    void trustAndNoticeAreWritten();
    void graphWithoutSense_data();
    void graphWithoutSense();
    void lostRevisionIsAskedFor();
    void pathIsFixedToKeyScans();
    void pathIsBrokenAtJumps_data();
    void pathIsBrokenAtJumps();
    void fastReplayHasAPath();
    void breaksGoWithTheirPoints();
    void piecesOfAPathAreDrawn();
};

namespace {

const QByteArray twoLoops = R"({"from":2,"to":118,"weight":0.9},{"from":30,"to":90,"weight":0.1})";
constexpr double drift = 0.3;
constexpr int last = EightDrive::keyScans - 1;

/// The panel on a matcher that says what the test wants; the drive is at its end, not yet corrected.
struct Session {
    explicit Session(bool isAtEnd = true) {
        panel.resize(800, 600);
        panel.show();
        fleet.add(QString("127.0.0.1:%1").arg(daemon.port()));
        [&] {
            for (const char *const topic : {"map", "graph", "pose"})
                QTRY_VERIFY(daemon.subscriptions(topic) > 0);
            if (isAtEnd)
                drive();
        }();
    }
    void drive() {
        daemon.say("map", bent.map(1));
        for (int i = 0; i < EightDrive::keyScans; ++i) {
            daemon.say("graph", bent.graph(i + 1, i == 0, i, i + 1, i + 1, i == last ? twoLoops : ""));
            if (i % 30 != 0)
                continue;
            QTRY_COMPARE(model.graph().size(), i + 1);
            daemon.say("pose", bent.poseMessage(i, false, bent));
            QTRY_VERIFY(model.pose() && isAt(*model.pose(), bent.pose(i)));
        }
        QTRY_COMPARE(model.graph().size(), EightDrive::keyScans);
        daemon.say("pose", bent.poseMessage(last, false, bent));
        QTRY_VERIFY(model.pose() && isAt(*model.pose(), bent.pose(last)));
        QTRY_COMPARE(model.edges().size(), 2 * EightDrive::keyScans);
    }
    void sayCorrected(char what) {
        if (what == 'm')
            daemon.say("map", straight.map(2));
        else if (what == 'g')
            daemon.say("graph", straight.graph(200, true, 0, last + 1, last + 1, twoLoops));
        else
            daemon.say("pose", straight.poseMessage(last, true, bent));
    }
    /// Until what was said is taken: a message without sense behind it is counted, a pose is told.
    void waitTaken(char what) {
        if (what == 'p') {
            QTRY_VERIFY(isAt(*model.pose(), straight.pose(last)));
            return;
        }
        const quint64 before = model.ignored();
        daemon.say(what == 'm' ? "map" : "graph", "[]");
        QTRY_VERIFY(model.ignored() > before);
    }
    static bool isAt(const Pose2D &a, const EightDrive::Pose &b) {
        return std::hypot(a.x - b.x, a.y - b.y) < 1e-6;
    }
    static bool isAt(QPointF a, const EightDrive::Pose &b) {
        return std::hypot(a.x() - b.x, a.y() - b.y) < 1e-6;
    }
    /// How far the end of the drive is shown on its way from bent (0) to straight (1); NaN: not on it.
    double part(QPointF shown) const {
        const auto from = bent.pose(last), to = straight.pose(last);
        const double length = std::hypot(to.x - from.x, to.y - from.y);
        const double along =
            ((shown.x() - from.x) * (to.x - from.x) + (shown.y() - from.y) * (to.y - from.y)) / length;
        const double aside =
            ((shown.x() - from.x) * (to.y - from.y) - (shown.y() - from.y) * (to.x - from.x)) / length;
        return std::abs(aside) < 0.05 * length ? along / length : std::nan("");
    }
    QByteArray svg() {
        const QString file = folder.filePath("view.svg");
        QFile text(file);
        return panel.exportTo(file).ok() && text.open(QIODevice::ReadOnly) ? text.readAll() : QByteArray();
    }

    const EightDrive bent{drift}, straight{0};
    QTemporaryDir folder;
    FakeDaemon daemon{Mischief{}};
    Fleet fleet;
    MapPanel panel{fleet};
    const MapModel &model = panel.model();
    MapView &view = panel.view();
};

QPointF pointOf(const Pose2D &pose) {
    return {pose.x, pose.y};
}

} // namespace

void TestMapCorrection::graphComesInParts() {
    Session s(false);
    s.daemon.say("graph", s.bent.graph(7, true, 0, 50, last + 1, ""));
    s.daemon.say("graph", s.bent.graph(7, false, 50, 100, last + 1, ""));
    s.daemon.say("graph", s.bent.graph(7, false, 100, last + 1, last + 1, twoLoops));
    QTRY_COMPARE(s.model.graph().size(), last + 1);
    for (int i = 0; i <= last; ++i)
        QVERIFY(Session::isAt(s.model.graph().poses[i], s.bent.pose(i)));
    QCOMPARE(s.model.graph().loops.size(), 2);
    QCOMPARE(s.model.graph().trust[60], 1 - 0.9 * 60 / EightDrive::keyScans);
    QVERIFY(!s.model.correction_m());
    QCOMPARE(s.model.ignored(), quint64(0));
}

void TestMapCorrection::correctionGlides_data() {
    QTest::addColumn<QByteArray>("order");
    for (const char *const order : {"mgp", "mpg", "gmp", "gpm", "pmg", "pgm"})
        QTest::newRow(order) << QByteArray(order);
}

// Whatever comes first, the picture stands until the last is here, then everything moves at once.
void TestMapCorrection::correctionGlides() {
    QFETCH(QByteArray, order);
    Session s;
    const auto before = s.model.edges();
    for (int i = 0; i < 3; ++i) {
        s.sayCorrected(order[i]);
        if (i == 2)
            break;
        QTRY_VERIFY(s.model.isGliding());
        s.waitTaken(order[i]);
        QCOMPARE(s.model.edges(), before);
        QVERIFY(std::abs(s.part(pointOf(*s.model.shownPose()))) < 1e-6);
        QVERIFY(std::abs(s.part(s.model.matchedPath().back())) < 1e-6);
    }
    int seen = 0;
    double latest = 0;
    const QLineF wall = before.last();
    QElapsedTimer clock;
    clock.start();
    while (s.model.isGliding() || seen == 0) {
        QVERIFY(clock.elapsed() < 5000 * slowness);
        QTest::qWait(5);
        const double robot = s.part(pointOf(*s.model.shownPose()));
        if (!s.model.isGliding() || robot <= 0 || robot >= 1)
            continue;
        ++seen;
        QVERIFY2(robot >= latest, "it moves one way");
        latest = robot;
        const double path = s.part(s.model.matchedPath().back());
        const double keyScan = s.part(pointOf(s.model.graph().poses.last()));
        QVERIFY2(std::abs(path - robot) < 0.1 && std::abs(keyScan - robot) < 0.1,
                 qPrintable(QString("%1 %2 %3").arg(robot).arg(path).arg(keyScan)));
        const QLineF now = s.model.edges().last();
        QVERIFY2(robot < 0.1 || QLineF(now.center(), wall.center()).length() > 1e-3, "the walls move too");
        QVERIFY(std::abs(now.length() - wall.length()) < 1e-6);
    }
    QVERIFY(seen > 3);
    for (int i = 0; i <= last; ++i)
        QVERIFY(Session::isAt(s.model.graph().poses[i], s.straight.pose(i)));
    QCOMPARE(s.model.matchedPath().size(), 5); // at each 30th key scan, and at the last
    for (int i = 0; i < 4; ++i)
        QVERIFY(Session::isAt(s.model.matchedPath()[i], s.straight.pose(30 * i)));
    QVERIFY(Session::isAt(s.model.matchedPath().back(), s.straight.pose(last)));
    QVERIFY(Session::isAt(*s.model.shownPose(), s.straight.pose(last)));
    const QPointF end = s.straight.wall(last, 0.5, 1.5);
    QVERIFY(QLineF(s.model.edges().last().p2(), end).length() < 1e-6);
    double farthest = 0;
    for (int i = 0; i <= last; ++i)
        farthest = qMax(farthest, QLineF(pointOf({s.bent.pose(i).x, s.bent.pose(i).y, 0}),
                                         pointOf({s.straight.pose(i).x, s.straight.pose(i).y, 0}))
                                      .length());
    QVERIFY(s.model.correction_m() && std::abs(*s.model.correction_m() - farthest) < 1e-6);
    s.daemon.say("pose", s.straight.poseMessage(last + 0.5, false, s.bent));
    QTRY_VERIFY(Session::isAt(s.model.matchedPath().back(), s.straight.pose(last + 0.5)));
    QCOMPARE(s.model.matchedPath().size(), 6); // no point lies in the frame before
}

void TestMapCorrection::viewThatFollowsDoesNotLeap() {
    Session s;
    s.view.zoom(1000); // as near as it goes
    QVERIFY(s.view.isFollowing());
    const QPointF centre(s.view.width() / 2.0, s.view.height() / 2.0);
    const auto middle = [&] { return s.view.transform().inverted().map(centre); };
    QTRY_VERIFY(Session::isAt(middle(), s.bent.pose(last)));
    const auto to = s.straight.pose(last);
    const double way = QLineF(middle(), QPointF(to.x, to.y)).length();
    double longest = 0;
    QPointF at = middle();
    connect(&s.model, &MapModel::changed, &s.view, [&] {
        longest = qMax(longest, QLineF(at, middle()).length());
        at = middle();
    });
    for (const char what : {'p', 'g', 'm'})
        s.sayCorrected(what);
    QTRY_VERIFY(Session::isAt(middle(), to));
    QVERIFY2(way > 0.1 && longest < 0.7 * way, qPrintable(QString("%1 of %2 m").arg(longest).arg(way)));
}

void TestMapCorrection::fittedViewShowsWhatGrows() {
    Session s;
    s.view.fit();
    QVERIFY(s.view.isFitting() && !s.view.isFollowing());
    const auto isInSight = [&](QPointF p) {
        return QRectF(s.view.rect()).contains(s.view.transform().map(p));
    };
    QVERIFY(!isInSight({200, 0}));
    s.daemon.say("map",
                 R"({"revision":2,"cleared":false,"edges":[{"id":900,"x1":200,"y1":0,"x2":200,"y2":9}],)"
                 R"("removed":[],"size":301})");
    QTRY_VERIFY(isInSight({200, 0}) && isInSight({200, 9}));
    s.view.resize(300, 500);
    QVERIFY(isInSight({200, 0}) && isInSight({200, 9}));
    s.view.zoom(4); // the operator looks closer: the view stays there
    QVERIFY(!s.view.isFitting() && !isInSight({200, 0}));
    s.view.fit();
    s.view.setFollowing(true);
    QVERIFY(!s.view.isFitting());
}

void TestMapCorrection::correctedAgainWhileItGlides() {
    Session s;
    for (const char what : {'p', 'g', 'm'})
        s.sayCorrected(what);
    QTRY_VERIFY(s.model.isGliding() && s.part(pointOf(*s.model.shownPose())) > 0.1);
    const QPointF before = pointOf(s.model.graph().poses.last());
    QPointF at = before;
    double longest = 0;
    connect(&s.model, &MapModel::changed, &s.view, [&] {
        const QPointF now = pointOf(s.model.graph().poses.last());
        longest = qMax(longest, QLineF(at, now).length());
        at = now;
    });
    const EightDrive other(-drift);
    s.daemon.say("graph", other.graph(300, true, 0, last + 1, last + 1, ""));
    s.daemon.say("map", other.map(3));
    s.daemon.say("pose", other.poseMessage(last, true, s.bent));
    QTRY_VERIFY(!s.model.isGliding() && Session::isAt(s.model.graph().poses.last(), other.pose(last)));
    const double way = QLineF(before, pointOf(s.model.graph().poses.last())).length();
    QVERIFY2(longest < 0.7 * way, qPrintable(QString("%1 of %2 m").arg(longest).arg(way)));
    QVERIFY(Session::isAt(s.model.matchedPath().back(), other.pose(last)));
}

void TestMapCorrection::correctionOfWhichNotAllComes_data() {
    QTest::addColumn<QByteArray>("what");
    for (const char *const what : {"g", "m", "mg", "pg"})
        QTest::newRow(what) << QByteArray(what);
}

// The picture waits, but not for ever, and the path goes on.
void TestMapCorrection::correctionOfWhichNotAllComes() {
    QFETCH(QByteArray, what);
    Session s;
    for (const char one : what)
        s.sayCorrected(one);
    QTRY_VERIFY(s.model.isGliding());
    QTRY_VERIFY_WITH_TIMEOUT(!s.model.isGliding(), 6000);
    const bool isCorrected = what.contains('g');
    QVERIFY(Session::isAt(s.model.matchedPath().back(), (isCorrected ? s.straight : s.bent).pose(last)));
    const EightDrive &walls = what.contains('m') ? s.straight : s.bent;
    QVERIFY(QLineF(s.model.edges().last().p2(), walls.wall(last, 0.5, 1.5)).length() < 1e-6);
    s.daemon.say("pose", s.straight.poseMessage(last + 0.5, false, s.bent));
    QTRY_VERIFY(Session::isAt(s.model.matchedPath().back(), s.straight.pose(last + 0.5)));
}

// Parts may take longer than the picture waits for nothing.
void TestMapCorrection::partsThatComeSlowly() {
    Session s;
    s.sayCorrected('p');
    s.sayCorrected('m');
    s.daemon.say("graph", s.straight.graph(200, true, 0, 40, last + 1, ""));
    for (const int first : {40, 80}) {
        QTest::qWait(int(MapModel::signWait.count()) - 500);
        QVERIFY(s.model.isGliding());
        s.daemon.say("graph", s.straight.graph(200, false, first, first + 40, last + 1, ""));
    }
    QTRY_VERIFY(s.part(pointOf(*s.model.shownPose())) > 0.1);
    QVERIFY(s.model.isGliding());
    QTRY_VERIFY(!s.model.isGliding());
    QVERIFY(Session::isAt(s.model.matchedPath().back(), s.straight.pose(last)));
}

void TestMapCorrection::largeMapIsNotAnimated() {
    KeyScans before, after;
    before.poses = {{0, 0, 0}, {1, 0, 0}};
    after.poses = {{0, 0, 0}, {1, 1, 0}};
    MovingMap now;
    now.graph = before;
    Glide glide;
    glide.hold(now, {});
    QVERIFY(glide.start(Glide::mostEdges, after));
    glide.hold(now, {});
    QVERIFY(!glide.start(Glide::mostEdges + 1, after));
    QVERIFY(glide.phase() == Glide::Phase::Rests);
    now.graph.poses.resize(Glide::mostKeyScans + 1);
    now.graph.poses[0].x = 1;
    after.poses.resize(now.graph.poses.size());
    glide.hold(now, {});
    QVERIFY(!glide.start(1, after));
}

void TestMapCorrection::clearedMapIsNoCorrection() {
    Session s;
    const QPolygonF path = s.model.matchedPath();
    s.daemon.say("map", R"({"revision":2,"cleared":true,"edges":[],"removed":[],"size":0})");
    QTRY_VERIFY(s.model.edges().isEmpty());
    QVERIFY(!s.model.isGliding());
    s.daemon.say("graph", s.straight.graph(200, true, 0, 0, 0, ""));
    QTRY_COMPARE(s.model.graph().size(), 0);
    s.daemon.say("graph", s.straight.graph(201, false, 0, 1, 1, ""));
    QTRY_COMPARE(s.model.graph().size(), 1);
    QVERIFY(!s.model.isGliding() && !s.model.correction_m());
    QCOMPARE(s.model.matchedPath(), path);
}

void TestMapCorrection::layersAreSwitched() {
    Session s;
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

void TestMapCorrection::trustAndNoticeAreWritten() {
    Session s;
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

void TestMapCorrection::graphWithoutSense_data() {
    QTest::addColumn<std::vector<GraphMessage>>("messages");
    QTest::addColumn<int>("ignored");
    QTest::addColumn<int>("size");
    QTest::addColumn<int>("loops");
    QTest::addColumn<bool>("isNext"); // after the last
    const double nan = std::nan(""), huge = 1e300;
    using Messages = std::vector<GraphMessage>;
    const GraphMessage good{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1, 1}, {{0, 1, 1}}, 2};
    const auto row = [](const char *name, const Messages &messages, int ignored, int size, int loops,
                        bool isNext = true) {
        QTest::newRow(name) << messages << ignored << size << loops << isNext;
    };
    const std::vector<std::array<double, 3>> many(1000000);
    row("good", {good}, 0, 2, 1);
    row("NaN", {{1, true, 0, {{0, 0, 0}, {nan, 0, 0}, {0, 0, nan}}, {1, nan, 1}, {{0, 1, nan}}, 3}}, 4, 3, 0);
    row("huge", {{1, true, 0, {{huge, 0, 0}, {0, -huge, 0}}, {huge, -huge}, {{0, 1, huge}}, 2}}, 5, 2, 0);
    row("trust is missing", {{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1}, {}, 2}}, 1, 2, 0);
    row("loops to nowhere", {good, {2, false, 2, {}, {}, {{0, 2, 1}, {-1, 0, 1}, {0, 1LL << 62, 1}}, 2}}, 3,
        2, 1);
    row("first beyond size", {good, {2, false, 9, {{0, 0, 0}}, {1}, {}, 5}}, 2, 2, 1);
    row("more than size", {{1, true, 0, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {1, 1, 1}, {}, 2}}, 1, 2, 0);
    row("first is negative", {good, {2, false, -1, {{0, 0, 0}}, {1}, {}, 2}}, 2, 2, 1);
    row("size is negative", {good, {2, false, 0, {{0, 0, 0}}, {1}, {}, -5}}, 2, 2, 1);
    row("key scan again", {good, {2, false, 1, {{1, 2, 0}}, {1}, {}, 2}}, 0, 2, 1);
    row("cleared amid parts", {{1, true, 0, {{0, 0, 0}}, {1}, {}, 9}, good}, 0, 2, 1);
    row("a revision is missed", {good, {3, false, 2, {{0, 0, 0}}, {1}, {}, 3}}, 0, 2, 1, false);
    row("a part is missed", {good, {2, false, 5, {{0, 0, 0}}, {1}, {}, 6}}, 0, 2, 1, false);
    row("waits for the whole", {good, {3, false, 2, {}, {}, {}, 3}, {4, false, 2, {{0, 0, 0}}, {1}, {}, 3}},
        0, 2, 1);
    row("the whole comes", {good, {3, false, 2, {}, {}, {}, 3}, good}, 0, 2, 1);
    row("a million key scans",
        {{1, true, 0, many, std::vector<double>(many.size(), 1), {}, 1000000},
         {2, false, 1000000, {{0, 0, 0}}, {1}, {}, 1000001}},
        1000000 - KeyScanGraph::mostKeyScans + 1, KeyScanGraph::mostKeyScans, 0);
    row("a million loops",
        {{1, true, 0, {{0, 0, 0}, {1, 0, 0}}, {1, 1}, std::vector<GraphLoop>(1000000, {0, 1, 1}), 2}},
        1000000 - KeyScanGraph::mostLoops, 2, KeyScanGraph::mostLoops);
}

void TestMapCorrection::graphWithoutSense() {
    QFETCH(std::vector<GraphMessage>, messages);
    QFETCH(int, ignored);
    QFETCH(int, size);
    QFETCH(int, loops);
    QFETCH(bool, isNext);
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

void TestMapCorrection::lostRevisionIsAskedFor() {
    Session s;
    s.daemon.say("graph", s.bent.graph(500, false, last + 1, last + 2, last + 2, ""));
    QTRY_VERIFY(s.daemon.subscriptions("graph") == 2);
    QCOMPARE(s.model.graph().size(), last + 1);
    s.daemon.say("graph", s.bent.graph(500, true, 0, last + 2, last + 2, ""));
    QTRY_COMPARE(s.model.graph().size(), last + 2);
    QVERIFY(!s.model.correction_m());
}

void TestMapCorrection::pathIsFixedToKeyScans() {
    DrivenPath path;
    path.add({0, 0, 0}, {}, DrivenPath::loose);
    path.fix(0);
    path.add({1, 0, 0}, {}, 1);
    path.frame = Pose2D{5, 5, 0};
    path.frameKeyScan = 1;
    path.correct({{0, 0, 0}, {1, 1, 0}}, {{10, 0, 0}, {1, 1, vectorlib::pi / 2}});
    QCOMPARE(path.way()[0], QPointF(10, 0));
    QVERIFY(QLineF(path.way()[1], QPointF(2, 1)).length() < 1e-9); // turned about its key scan
    QVERIFY(std::hypot(path.frame->x - -3, path.frame->y - 5) < 1e-9);
    for (int i = 0; i < 150000; ++i)
        path.add({double(i), 0, 0}, {}, 0);
    QVERIFY(path.way().size() <= 100000);
    QCOMPARE(path.way().size(), path.keyScans().size());
}

void TestMapCorrection::pathIsBrokenAtJumps_data() {
    QTest::addColumn<double>("distance");
    QTest::addColumn<double>("seconds");
    QTest::addColumn<double>("speed");
    QTest::addColumn<bool>("isJump");
    QTest::newRow("standing") << 0.0 << 0.1 << 0.0 << false;
    QTest::newRow("standing for long") << 0.01 << 60.0 << 0.0 << false;
    QTest::newRow("driving") << 0.1 << 0.1 << 1.0 << false;
    QTest::newRow("corrected a little") << 0.08 << 0.1 << 0.0 << false;
    QTest::newRow("placed beside") << 0.3 << 0.1 << 0.0 << true;
    QTest::newRow("placed while driving") << 0.6 << 0.1 << 1.0 << true;
    QTest::newRow("a second of driving") << 1.0 << 1.0 << 1.0 << false;
    QTest::newRow("begins to drive, seldom told") << 0.5 << 1.0 << 0.0 << false;
    QTest::newRow("a long gap") << 1.0 << 10.0 << 1.0 << true;
    QTest::newRow("a replay jumps ahead") << 5.0 << 60.0 << 1.0 << true;
    QTest::newRow("a replay jumps back") << 1.0 << -60.0 << 1.0 << true;
    QTest::newRow("an impossible speed") << 50.0 << 0.1 << 1e6 << true;
    QTest::newRow("no time") << 1.0 << std::nan("") << 1.0 << true;
    QTest::newRow("no speed") << 1.0 << 0.1 << std::nan("") << true;
}

void TestMapCorrection::pathIsBrokenAtJumps() {
    QFETCH(double, distance);
    QFETCH(double, seconds);
    QFETCH(double, speed);
    QFETCH(bool, isJump);
    constexpr double start = 1718000000;
    DrivenPath path;
    path.add({0, 0, 0}, {start, speed}, 0);
    path.add({distance, 0, 0}, {start + seconds, speed}, 0);
    QCOMPARE(path.breaks(), isJump ? QVector<int>{1} : QVector<int>{});
}

// Of a replay that is as fast as can be, each fiftieth odometry is told.
void TestMapCorrection::fastReplayHasAPath() {
    DrivenPath path;
    for (int i = 0; i < 10; ++i)
        path.add({2.0 * i, 0, 0}, {5.0 * i, 0.4}, 0);
    QCOMPARE(path.breaks(), QVector<int>{1}); // the first gap is not known to be usual
    path.add({30, 0, 0}, {200, 0.4}, 0);
    QCOMPARE(path.breaks(), (QVector<int>{1, 10}));
}

void TestMapCorrection::breaksGoWithTheirPoints() {
    DrivenPath path;
    for (int i = 0; i < 100000; ++i) // 20 jumps, the first at once
        path.add({0.05 * i + (i >= 1 ? 10 : 0) + 10 * int(i / 5000), 0, 0}, {0.1 * i, 0.5}, 0);
    QCOMPARE(path.breaks().size(), 20);
    QCOMPARE(path.breaks().front(), 1);
    path.add({1e4, 0, 0}, {1e4, 0.5}, 0); // the oldest 10,000 points go
    QCOMPARE(path.breaks().size(), 18);   // those at 1, 5000 and 10,000 went, one came
    for (const int first : path.breaks())
        QVERIFY(path.way()[first].x() - path.way()[first - 1].x() > 5);
}

void TestMapCorrection::piecesOfAPathAreDrawn() {
    const QPolygonF path(QVector<QPointF>{{0, 0}, {10, 0}, {20, 0}, {500, 500}, {20, 20}, {10, 20}});
    const QRectF seen(0, 0, 100, 100);
    const auto pieces = recent(path, {3, 4}, seen, 1e6);
    QCOMPARE(pieces.size(), 2); // a point alone is no line
    QCOMPARE(pieces[0], QPolygonF(path.mid(4)));
    QCOMPARE(pieces[1], QPolygonF(path.mid(0, 3)));
    QCOMPARE(recent(path, {3, 4}, seen, 15).size(), 2);
    QCOMPARE(recent(path, {3, 4}, seen, 15).back().size(), 2); // the oldest is left out
    QCOMPARE(recent(path, {3, 4}, seen, 5).size(), 1);
    QVERIFY(recent({}, {}, seen, 5).isEmpty());
    QCOMPARE(recent(path, {2, 700}, seen, 1e6).size(), 2); // numbers of points that there are not
}

QTEST_MAIN(TestMapCorrection)
#include "TestMapCorrection.moc"
