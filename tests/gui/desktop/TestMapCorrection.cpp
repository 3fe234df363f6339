#include "tests/gui/desktop/EightSession.h"

using namespace hermes;

/// A map that is corrected while the operator looks at it.
class TestMapCorrection : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void correctionGlides_data() { rowsOf<QByteArray>("order", {"mgp", "mpg", "gmp", "gpm", "pmg", "pgm"}); }

    // Whatever comes first, the picture stands until the lastKeyScan is here, then everything moves at once.
    void correctionGlides() {
        QFETCH(QByteArray, order);
        EightSession s;
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
        auto clock = runningTimer();
        while (s.model.isGliding() || seen == 0) {
            QVERIFY(clock.elapsed() < 5000 * patience);
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
                     saying("%1 %2 %3", robot, path, keyScan));
            const QLineF now = s.model.edges().last();
            QVERIFY2(robot < 0.1 || QLineF(now.center(), wall.center()).length() > 1e-3,
                     "the walls move too");
            QVERIFY(std::abs(now.length() - wall.length()) < 1e-6);
        }
        QVERIFY(seen > 3);
        for (int i = 0; i <= lastKeyScan; ++i)
            QVERIFY(EightSession::isAt(s.model.graph().poses[i], s.straight.pose(i)));
        QCOMPARE(s.model.matchedPath().size(), 5); // at each 30th key scan, and at the lastKeyScan
        for (int i = 0; i < 4; ++i)
            QVERIFY(EightSession::isAt(s.model.matchedPath()[i], s.straight.pose(30 * i)));
        QVERIFY(EightSession::isAt(s.model.matchedPath().back(), s.straight.pose(lastKeyScan)));
        QVERIFY(EightSession::isAt(*s.model.shownPose(), s.straight.pose(lastKeyScan)));
        const QPointF end = s.straight.wall(lastKeyScan, 0.5, 1.5);
        QVERIFY(QLineF(s.model.edges().last().p2(), end).length() < 1e-6);
        double farthest = 0;
        for (int i = 0; i <= lastKeyScan; ++i)
            farthest = qMax(farthest, QLineF(pointOf({s.bent.pose(i).x, s.bent.pose(i).y, 0}),
                                             pointOf({s.straight.pose(i).x, s.straight.pose(i).y, 0}))
                                          .length());
        QVERIFY(s.model.correction_m() && std::abs(*s.model.correction_m() - farthest) < 1e-6);
        s.daemon.say("pose", s.straight.poseMessage(lastKeyScan + 0.5, false, s.bent));
        QTRY_VERIFY(EightSession::isAt(s.model.matchedPath().back(), s.straight.pose(lastKeyScan + 0.5)));
        QCOMPARE(s.model.matchedPath().size(), 6); // no point lies in the frame before
    }

    void viewThatFollowsDoesNotLeap() {
        EightSession s;
        s.view.zoom(1000); // as near as it goes
        QVERIFY(s.view.isFollowing());
        const QPointF centre(s.view.width() / 2.0, s.view.height() / 2.0);
        const auto middle = [&] { return s.view.transform().inverted().map(centre); };
        QTRY_VERIFY(EightSession::isAt(middle(), s.bent.pose(lastKeyScan)));
        const auto to = s.straight.pose(lastKeyScan);
        const double way = QLineF(middle(), QPointF(to.x, to.y)).length();
        double longest = 0;
        QPointF at = middle();
        connect(&s.model, &MapModel::changed, &s.view, [&] {
            longest = qMax(longest, QLineF(at, middle()).length());
            at = middle();
        });
        for (const char what : {'p', 'g', 'm'})
            s.sayCorrected(what);
        QTRY_VERIFY(EightSession::isAt(middle(), to));
        QVERIFY2(way > 0.1 && longest < 0.7 * way, saying("%1 of %2 m", longest, way));
    }

    void fittedViewShowsWhatGrows() {
        EightSession s;
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

    void correctedAgainWhileItGlides() {
        EightSession s;
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
        const EightDrive other(-usualDrift);
        s.daemon.say("graph", other.graph(300, true, 0, lastKeyScan + 1, lastKeyScan + 1, ""));
        s.daemon.say("map", other.map(3));
        s.daemon.say("pose", other.poseMessage(lastKeyScan, true, s.bent));
        QTRY_VERIFY(!s.model.isGliding() &&
                    EightSession::isAt(s.model.graph().poses.last(), other.pose(lastKeyScan)));
        const double way = QLineF(before, pointOf(s.model.graph().poses.last())).length();
        QVERIFY2(longest < 0.7 * way, saying("%1 of %2 m", longest, way));
        QVERIFY(EightSession::isAt(s.model.matchedPath().back(), other.pose(lastKeyScan)));
    }

    void correctionOfWhichNotAllComes_data() { rowsOf<QByteArray>("what", {"g", "m", "mg", "pg"}); }

    // The picture waits, but not for ever, and the path goes on.
    void correctionOfWhichNotAllComes() {
        QFETCH(QByteArray, what);
        EightSession s;
        for (const char one : what)
            s.sayCorrected(one);
        QTRY_VERIFY(s.model.isGliding());
        QTRY_VERIFY_WITH_TIMEOUT(!s.model.isGliding(), 6000);
        const bool isCorrected = what.contains('g');
        QVERIFY(EightSession::isAt(s.model.matchedPath().back(),
                                   (isCorrected ? s.straight : s.bent).pose(lastKeyScan)));
        const EightDrive &walls = what.contains('m') ? s.straight : s.bent;
        QVERIFY(QLineF(s.model.edges().last().p2(), walls.wall(lastKeyScan, 0.5, 1.5)).length() < 1e-6);
        s.daemon.say("pose", s.straight.poseMessage(lastKeyScan + 0.5, false, s.bent));
        QTRY_VERIFY(EightSession::isAt(s.model.matchedPath().back(), s.straight.pose(lastKeyScan + 0.5)));
    }

    // Parts may take longer than the picture waits for nothing.
    void partsThatComeSlowly() {
        EightSession s;
        s.sayCorrected('p');
        s.sayCorrected('m');
        s.daemon.say("graph", s.straight.graph(200, true, 0, 40, lastKeyScan + 1, ""));
        for (const int first : {40, 80}) {
            QTest::qWait(int(MapModel::signWait.count()) - 500);
            QVERIFY(s.model.isGliding());
            s.daemon.say("graph", s.straight.graph(200, false, first, first + 40, lastKeyScan + 1, ""));
        }
        QTRY_VERIFY(s.part(pointOf(*s.model.shownPose())) > 0.1);
        QVERIFY(s.model.isGliding());
        QTRY_VERIFY(!s.model.isGliding());
        QVERIFY(EightSession::isAt(s.model.matchedPath().back(), s.straight.pose(lastKeyScan)));
    }

    void largeMapIsNotAnimated() {
        KeyScans before, after;
        before.poses = {{0, 0, 0}, {1, 0, 0}};
        after.poses = {{0, 0, 0}, {1, 1, 0}};
        MovingMap now;
        now.graph = before;
        Glide glide;
        glide.hold(now, {});
        QVERIFY(glide.start(Glide::maxEdges, after));
        glide.hold(now, {});
        QVERIFY(!glide.start(Glide::maxEdges + 1, after));
        QVERIFY(glide.phase() == Glide::Phase::Rests);
        now.graph.poses.resize(Glide::maxKeyScans + 1);
        now.graph.poses[0].x = 1;
        after.poses.resize(now.graph.poses.size());
        glide.hold(now, {});
        QVERIFY(!glide.start(1, after));
    }

    void clearedMapIsNoCorrection() {
        EightSession s;
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
};
