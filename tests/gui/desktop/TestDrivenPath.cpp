#include "gui/desktop/view/Clipping.h"
#include "gui/desktop/view/MapPainter.h"
#include "tests/gui/desktop/EightSession.h"
#include "tests/support/ThreadTime.h"

using namespace hermes;

/// The path that was driven: fixed to key scans, and broken at jumps.
class TestDrivenPath : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void pathIsFixedToKeyScans() {
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

    void pathIsBrokenAtJumps_data() {
        const Rows<double, double, double, bool> row("distance", "seconds", "speed", "isJump");
        row("standing", 0.0, 0.1, 0.0, false);
        row("standing for long", 0.01, 60.0, 0.0, false);
        row("driving", 0.1, 0.1, 1.0, false);
        row("corrected a little", 0.08, 0.1, 0.0, false);
        row("placed beside", 0.3, 0.1, 0.0, true);
        row("placed while driving", 0.6, 0.1, 1.0, true);
        row("a second of driving", 1.0, 1.0, 1.0, false);
        row("begins to drive, seldom told", 0.5, 1.0, 0.0, false);
        row("a long gap", 1.0, 10.0, 1.0, true);
        row("a replay jumps ahead", 5.0, 60.0, 1.0, true);
        row("a replay jumps back", 1.0, -60.0, 1.0, true);
        row("an impossible speed", 50.0, 0.1, 1e6, true);
        row("no time", 1.0, std::nan(""), 1.0, true);
        row("no speed", 1.0, 0.1, std::nan(""), true);
    }

    void pathIsBrokenAtJumps() {
        FETCH(double, distance, double, seconds, double, speed, bool, isJump);
        constexpr double start = 1718000000;
        DrivenPath path;
        path.add({0, 0, 0}, {start, speed}, 0);
        path.add({distance, 0, 0}, {start + seconds, speed}, 0);
        QCOMPARE(path.breaks(), isJump ? QVector<int>{1} : QVector<int>{});
    }

    // Of a replay that is as fast as can be, each fiftieth odometry is told.
    void fastReplayHasAPath() {
        DrivenPath path;
        for (int i = 0; i < 10; ++i)
            path.add({2.0 * i, 0, 0}, {5.0 * i, 0.4}, 0);
        QCOMPARE(path.breaks(), QVector<int>{1}); // the first gap is not known to be usual
        path.add({30, 0, 0}, {200, 0.4}, 0);
        QCOMPARE(path.breaks(), (QVector<int>{1, 10}));
    }

    void breaksGoWithTheirPoints() {
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

    void piecesOfAPathAreDrawn() {
        const QPolygonF path(QVector<QPointF>{{0, 0}, {10, 0}, {20, 0}, {500, 500}, {20, 20}, {10, 20}});
        const QRectF seen(0, 0, 100, 100);
        const auto pieces = recent(path, {3, 4}, {}, seen, 1e6);
        QCOMPARE(pieces.size(), 2); // a point alone is no line
        QCOMPARE(pieces[0], QPolygonF(path.mid(4)));
        QCOMPARE(pieces[1], QPolygonF(path.mid(0, 3)));
        QCOMPARE(recent(path, {3, 4}, {}, seen, 15).size(), 2);
        QCOMPARE(recent(path, {3, 4}, {}, seen, 15).back().size(), 2); // the oldest is left out
        QCOMPARE(recent(path, {3, 4}, {}, seen, 5).size(), 1);
        QVERIFY(recent({}, {}, {}, seen, 5).isEmpty());
        QCOMPARE(recent(path, {2, 700}, {}, seen, 1e6).size(), 2); // numbers of points that there are not
    }

    void pointsThatNobodyCanTellApart() {
        QPolygonF path;
        for (int i = 0; i <= 1000; ++i)
            path.append({0.1 * i, 0});
        const auto pieces = recent(path, {505}, {}, QRectF(-1, -1, 200, 200), 1e6);
        QCOMPARE(pieces.size(), 2);
        QCOMPARE(pieces[0].back(), path.back());
        QCOMPARE(pieces[0].front(), path[505]);
        QCOMPARE(pieces[1].back(), path[504]);
        QCOMPARE(pieces[1].front(), path.front());
        for (const QPolygonF &piece : pieces)
            QVERIFY2(piece.size() > 20 && piece.size() < 30, saying(piece.size()));
    }

    // 700 m of circles, one upon the other: such ways are drawn ten times a second, in far less time than Qt
    // needs for all their points.
    void anHourOfCirclesIsDrawnFast() {
        QPolygonF way; // metres
        for (int i = 0; i < 35000; ++i)
            way.append({(0.9 + 1e-6 * i) * std::cos(0.02 * i), 0.9 * std::sin(0.02 * i)});
        QImage image(1280, 720, QImage::Format_RGB32);
        image.fill(Qt::white);
        QPainter painter(&image);
        const auto draw_ms = [](const auto &draw) {
            double least = 1e9;
            for (int i = 0; i < 20; ++i) {
                const double before = threadTime_ms();
                draw();
                least = std::min(least, threadTime_ms() - before);
            }
            return least;
        };
        const QTransform place(60, 0, 0, -60, 640, 360);
        double ours = 0, plain = 0;
        for (const Qt::PenStyle style : {Qt::SolidLine, Qt::DashLine, Qt::DotLine}) {
            const QPen pen(Qt::red, 1.5, style);
            ours += draw_ms([&] { paintWay(painter, way, {}, place, image.size(), pen); });
            painter.setPen(pen);
            plain += draw_ms([&] { painter.drawPolyline(place.map(way)); });
        }
        qInfo("figure three ways of 700 m: %.1f ms of the processor, by Qt alone %.1f ms", ours, plain);
        QVERIFY2(ours < 0.7 * plain, saying("%1 of %2", ours, plain));
        painter.end();
        const QColor drawn = image.pixelColor(640 + 54, 360);
        QVERIFY2(drawn.red() > 200 && drawn.green() < 200, qPrintable(drawn.name()));
    }
};
