#include "tests/gui/desktop/MapWindow.h"

using namespace hermes;

/// What the map shows of a robot that stands in a simulated hall, and how one looks around in it.
class TestMapView : public QObject, protected MapWindow {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { open(); }

    void mapScanAndRobotAreShown() {
        QTRY_VERIFY(model().scan().size() > 500);
        QTRY_VERIFY(model().segments().size() > 10);
        QTRY_VERIFY(model().correspondences().size() > 5);
        QTRY_VERIFY(model().covariance());
        QTRY_COMPARE(model().outcome(), QString("matched"));
        // The points of the scan lie on edges of the map.
        int near = 0;
        for (const QPointF &p : model().scan())
            for (const QLineF &edge : model().edges()) {
                const QPointF d = edge.p2() - edge.p1(), e = p - edge.p1();
                const double along = QPointF::dotProduct(d, e) / QPointF::dotProduct(d, d);
                const QPointF off = e - qBound(0.0, along, 1.0) * d;
                if (std::hypot(off.x(), off.y()) < 0.1) {
                    ++near;
                    break;
                }
            }
        QVERIFY2(near > 0.8 * model().scan().size(), saying(near));
    }

    void panZoomFitFollow() {
        tool("fit");
        QVERIFY(!view().isFollowing());
        for (const QLineF &edge : model().edges())
            QVERIFY(QRectF(view().rect()).contains(view().transform().map(edge.center())));
        const QPoint here = pixel(1, 1);
        QWheelEvent wheel(here, view().mapToGlobal(here), {}, {0, 120}, Qt::NoButton, {}, Qt::NoScrollPhase,
                          false);
        const double before = scale();
        QApplication::sendEvent(&view(), &wheel);
        QCOMPARE(scale(), 1.2 * before);
        QVERIFY((pixel(1, 1) - here).manhattanLength() <= 2); // what is under the pointer stays there
        drag(here, here + QPoint(60, -40));
        QVERIFY((pixel(1, 1) - here - QPoint(60, -40)).manhattanLength() <= 3);
        tool("follow");
        QVERIFY(view().isFollowing());
        QTRY_VERIFY((pixel(model().pose()->x, model().pose()->y) - view().rect().center()).manhattanLength() <
                    4);
        drag(here, here + QPoint(60, -40)); // looking elsewhere ends it
        QVERIFY(!view().isFollowing());
        QVERIFY(!panel()->findChild<QAction *>("follow")->isChecked());
    }

    void keysOfTheView() {
        view().setFocus();
        const double before = scale();
        QTest::keyClick(&view(), Qt::Key_Plus);
        QCOMPARE(scale(), 1.2 * before);
        QTest::keyClick(&view(), Qt::Key_Minus);
        QCOMPARE(scale(), before);
        QTest::keyClick(&view(), Qt::Key_F);
        QVERIFY(view().isFollowing());
        QTest::keyClick(&view(), Qt::Key_0);
        QVERIFY(!view().isFollowing());
    }

    // Whoever opens the window sees all of the map, with the robot in the middle.
    void firstViewShowsTheMap() {
        auto other = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(other->show());
        MapPanel &map = other->window.map();
        const auto isSeen = [&map](const QLineF &edge) {
            const QRectF seen(map.view().rect());
            return seen.contains(map.view().transform().map(edge.center()));
        };
        QTRY_VERIFY_WITH_TIMEOUT(map.model().edges().size() > 10 && map.model().pose(), 10000);
        QTRY_VERIFY(map.view().isFollowing() &&
                    std::all_of(map.model().edges().begin(), map.model().edges().end(), isSeen));
        const QPointF robot =
            map.view().transform().map(QPointF(map.model().pose()->x, map.model().pose()->y));
        QVERIFY(QLineF(robot, QRectF(map.view().rect()).center()).length() < 5);
        const double before = map.view().transform().m11();
        map.view().zoom(3);
        QTest::qWait(500);                                                   // messages come
        QVERIFY(std::abs(map.view().transform().m11() - 3 * before) < 1e-9); // as the operator wants it
        other.reset();
        QVERIFY(window_->show());
    }

    void coordinatesUnderTheMouse() {
        tool("fit");
        auto *const cursor = view().findChild<QLabel *>("cursor");
        const QPoint at = pixel(1, 2);
        QMouseEvent move(QEvent::MouseMove, at, Qt::NoButton, {}, {});
        QApplication::sendEvent(&view(), &move);
        QVERIFY(cursor->isVisible());
        const QRegularExpression form("^x (-?\\d+\\.\\d+) m, y (-?\\d+\\.\\d+) m$");
        const auto read = form.match(cursor->text());
        QVERIFY2(read.hasMatch(), qPrintable(cursor->text()));
        const double pixel_m = 1 / scale() + 0.01;
        QVERIFY(std::abs(read.captured(1).toDouble() - 1) < pixel_m);
        QVERIFY(std::abs(read.captured(2).toDouble() - 2) < pixel_m);
        QVERIFY(view().rect().contains(cursor->geometry()));
        const QString before = cursor->text();
        view().zoom(2); // the mouse stands still, the map does not
        QVERIFY(cursor->text() != before);
        QEvent leave(QEvent::Leave);
        QApplication::sendEvent(&view(), &leave);
        QVERIFY(!cursor->isVisible());
        tool("fit");
    }

    void poseInNumbers() {
        QCOMPARE(poseText({1.234, -0.5, vectorlib::pi / 2}), QString("x 1.23 m, y -0.50 m, 90.0°"));
        QCOMPARE(poseText({0, 0, 7 * vectorlib::pi / 2}), QString("x 0.00 m, y 0.00 m, -90.0°"));
        QCOMPARE(poseText({-0.001, -0.004, -1e-4}), QString("x 0.00 m, y 0.00 m, 0.0°"));
        QCOMPARE(uncertaintyText({1e-4, 0, 0, 0, 0.25, 0, 0, 0, 1e-4}),
                 QString("± 0.020 m, ± 0.98 m, ± 1.1° (95 %)"));
        QCOMPARE(uncertaintyText({-1, 0, 0, 0, 0, 0, 0, 0, 1e12}),
                 QString("± 0.000 m, ± 0.000 m, ± 180.0° (95 %)"));
        // And they stand on the map.
        QTRY_VERIFY(model().covariance());
        const QString file = robot_->path("numbers.svg");
        QVERIFY(panel()->exportTo(file).ok());
        const QString svg = QString::fromUtf8(contentOf(file));
        QVERIFY(svg.contains(poseText(*model().pose()).section(',', 0, 0)));
        QVERIFY(svg.contains("(95 %)"));
    }

    // A line below the map makes the view lower.
    void aNoteKeepsTheScale() {
        auto other = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(other->show());
        MapPanel &map = other->window.map();
        const auto scaleOf = [&map] { return map.view().transform().m11(); };
        QTRY_VERIFY_WITH_TIMEOUT(map.model().edges().size() > 10 && map.model().pose(), 10000);
        QTest::qWait(200); // it is laid out
        auto *const message = map.findChild<QLabel *>("message");
        message->hide();
        QCoreApplication::processEvents();
        for (const bool isFitting : {false, true}) {
            map.view().setFollowing(!isFitting);
            map.view().setFitting(isFitting);
            QCoreApplication::processEvents();
            const int height = map.view().height();
            const double before = scaleOf();
            message->setText("Wrote 12 walls");
            message->show();
            QCoreApplication::processEvents();
            QCOMPARE(scaleOf(), before);
            message->hide();
            QTRY_VERIFY(std::abs(map.view().height() - height) <= 2); // as before, but for a line
            QCOMPARE(scaleOf(), before);
        }
        other.reset();
        QVERIFY(window_->show());
    }

    void layersAreSwitched() {
        const QStringList names{"Grid",    "Map",     "Scan",  "Segments", "Correspondences",
                                "Path as", "Path by", "True",  "Robot",    "Uncertainty",
                                "Pose",    "Loops",   "Graph", "Trust"};
        QStringList found;
        for (const QAction *const action : panel()->findChild<QMenu *>("layers")->actions())
            if (action->isCheckable())
                found.append(action->text());
        QCOMPARE(found.size(), names.size());
        for (int i = 0; i < names.size(); ++i)
            VERIFY_STARTS(found[i], names[i]);
        // The picture stands still without scans.
        robot_->signal("scanmatcher", SIGSTOP);
        robot_->signal("velodynelogger", SIGSTOP);
        QTRY_VERIFY_WITH_TIMEOUT(!model().poseAge().isFresh() && !model().scanAge().isFresh(), 5000);
        view().layers().numbers = false; // its age counts up
        for (const char *const name : {"Grid", "Map", "Scan", "Segments", "Robot", "Uncertainty"})
            for (QAction *const action : panel()->findChild<QMenu *>("layers")->actions())
                if (action->text().startsWith(name)) {
                    const QImage before = view().grab().toImage();
                    action->toggle();
                    QVERIFY2(view().grab().toImage() != before, name);
                    action->toggle();
                    QVERIFY2(view().grab().toImage() == before, name);
                }
        view().layers().numbers = true;
        robot_->signal("velodynelogger", SIGCONT);
        robot_->signal("scanmatcher", SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(model().poseAge().isFresh() && model().scanAge().isFresh(), 20000);
    }

    void layersAreKept() {
        const QString file = robot_->path("gui.json");
        for (const bool isFirst : {true, false}) {
            Fleet fleet;
            DriveControl drive(fleet);
            MainWindow other(fleet, drive, file);
            const auto isTicked = [&other](const char *layer) {
                return other.map().findChild<QAction *>(layer)->isChecked();
            };
            QCOMPARE(isTicked("gridLayer"), isFirst);
            QCOMPARE(isTicked("graphLayer"), !isFirst);
            QVERIFY(isTicked("robotLayer"));
            other.map().findChild<QAction *>("gridLayer")->setChecked(false);
            other.map().findChild<QAction *>("graphLayer")->setChecked(true);
            QVERIFY(!other.map().view().layers().grid);
            other.close();
        }
        QVERIFY(window_->show());
    }

    void pathIsBrokenWhereTheRobotJumps() {
        const Pose2D at = *model().pose();
        const auto breaks = [this] { return model().breaks(MovingMap::Matched).size(); };
        const int before = breaks();
        auto *const matcher = window_->fleet.robot()->withName("scanmatcher");
        for (const double shift : {50.0, 0.0}) { // there and back
            const QJsonObject pose{{"x", at.x + shift}, {"y", at.y}, {"theta", at.theta}};
            matcher->call("pose.set", pose, this, [](const Result<QJsonValue> &) {});
            QTRY_VERIFY(std::abs(model().pose()->x - at.x - shift) < 1);
        }
        QVERIFY2(breaks() >= before + 2, saying(breaks()));
        QTRY_COMPARE(model().outcome(), QString("matched"));
    }
};
