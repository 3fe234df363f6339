#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QAction>
#include <QDialog>
#include <QFileInfo>
#include <QImage>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPlainTextEdit>
#include <QRegularExpression>
#include <QToolBar>
#include <QToolButton>
#include <QWheelEvent>
#include <QXmlStreamReader>

using namespace hermes;
using namespace hermes::desktop;

/// The map of a robot that stands in a simulated hall.
class TestMapPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase();
    void cleanupTestCase();
    void mapScanAndRobotAreShown();
    void panZoomFitFollow();
    void keysOfTheView();
    void firstViewShowsTheMap();
    void coordinatesUnderTheMouse();
    void poseInNumbers();
    void layersAreSwitched();
    void layersAreKept();
    void pathIsBrokenWhereTheRobotJumps();
    void measured();
    void placedByADrag();
    void exported_data();
    void exported();
    void exportThatFails();
    void savedByCommand();
    void twoClicksSaveIt();
    void mapsByTheMenu();
    void matcherGoneAndBack();

private:
    MapPanel *panel() const { return window_->window.findChild<MapPanel *>(); }
    MapView &view() const { return panel()->view(); }
    const MapModel &model() const { return panel()->model(); }
    QString message() const { return panel()->findChild<QLabel *>("message")->text(); }
    void tool(const QString &name) const {
        auto *const bar = panel()->findChild<QToolBar *>();
        auto *const button = bar->widgetForAction(panel()->findChild<QAction *>(name));
        QVERIFY2(button && button->isEnabled(), qPrintable(name));
        QTest::mouseClick(button, Qt::LeftButton);
    }
    QPoint pixel(double x, double y) const { return view().transform().map(QPointF(x, y)).toPoint(); }
    void drag(QPoint from, QPoint to) const {
        QTest::mousePress(&view(), Qt::LeftButton, {}, from);
        QMouseEvent move(QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(&view(), &move);
        QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
    }
    double scale() const { return view().transform().m11(); }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
};

void TestMapPanel::initTestCase() {
    robot_ = std::make_unique<RobotProcesses>();
    robot_->startAll();
    window_ = std::make_unique<OpenWindow>(*robot_);
    QVERIFY(window_->show());
    QTRY_VERIFY_WITH_TIMEOUT(model().pose() && model().edges().size() > 10, 20000);
}

void TestMapPanel::cleanupTestCase() {
    window_.reset();
    robot_.reset();
}

void TestMapPanel::mapScanAndRobotAreShown() {
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
    QVERIFY2(near > 0.8 * model().scan().size(), qPrintable(QString::number(near)));
}

// Whoever opens the window sees all of the map, with the robot in the middle.
void TestMapPanel::firstViewShowsTheMap() {
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
    const QPointF robot = map.view().transform().map(QPointF(map.model().pose()->x, map.model().pose()->y));
    QVERIFY(QLineF(robot, QRectF(map.view().rect()).center()).length() < 5);
    const double before = map.view().transform().m11();
    map.view().zoom(3);
    QTest::qWait(500);                                                   // messages come
    QVERIFY(std::abs(map.view().transform().m11() - 3 * before) < 1e-9); // as the operator wants it
    other.reset();
    QVERIFY(window_->show());
}

void TestMapPanel::coordinatesUnderTheMouse() {
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

void TestMapPanel::poseInNumbers() {
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
    QFile picture(file);
    QVERIFY(picture.open(QIODevice::ReadOnly));
    const QString svg = QString::fromUtf8(picture.readAll());
    QVERIFY(svg.contains(poseText(*model().pose()).section(',', 0, 0)));
    QVERIFY(svg.contains("(95 %)"));
}

void TestMapPanel::layersAreSwitched() {
    const QStringList names{"Grid",    "Map",     "Scan",  "Segments", "Correspondences",
                            "Path as", "Path by", "True",  "Robot",    "Uncertainty",
                            "Pose",    "Loops",   "Graph", "Trust"};
    QStringList found;
    for (const QAction *const action : panel()->findChild<QMenu *>("layers")->actions())
        if (action->isCheckable())
            found.append(action->text());
    QCOMPARE(found.size(), names.size());
    for (int i = 0; i < names.size(); ++i)
        QVERIFY2(found[i].startsWith(names[i]), qPrintable(found[i]));
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

void TestMapPanel::layersAreKept() {
    const QString file = robot_->path("gui.ini");
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

void TestMapPanel::pathIsBrokenWhereTheRobotJumps() {
    const Pose2D at = *model().pose();
    const auto breaks = [this] { return model().breaks(MovingMap::Matched).size(); };
    const int before = breaks();
    auto *const matcher = window_->fleet.robot()->withName("scanmatcher");
    for (const double shift : {50.0, 0.0}) { // there and back
        const QJsonObject pose{{"x", at.x + shift}, {"y", at.y}, {"theta", at.theta}};
        matcher->call("pose.set", pose, this, [](const Result<QJsonValue> &) {});
        QTRY_VERIFY(std::abs(model().pose()->x - at.x - shift) < 1);
    }
    QVERIFY2(breaks() >= before + 2, qPrintable(QString::number(breaks())));
    QTRY_COMPARE(model().outcome(), QString("matched"));
}

void TestMapPanel::panZoomFitFollow() {
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
    QTRY_VERIFY((pixel(model().pose()->x, model().pose()->y) - view().rect().center()).manhattanLength() < 4);
    drag(here, here + QPoint(60, -40)); // looking elsewhere ends it
    QVERIFY(!view().isFollowing());
    QVERIFY(!panel()->findChild<QAction *>("follow")->isChecked());
}

void TestMapPanel::keysOfTheView() {
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

void TestMapPanel::measured() {
    tool("fit");
    tool("measure");
    drag(pixel(0, 0), pixel(3, 4));
    QVERIFY2(std::abs(message().section(' ', 0, 0).toDouble() - 5) < 2 / scale() + 1e-3,
             qPrintable(message()));
    tool("measure"); // off again
    QVERIFY(view().tool() == MapView::Tool::Pan);
}

void TestMapPanel::placedByADrag() {
    const Pose2D at = *model().pose();
    const double reach = 40 / scale();
    tool("place");
    drag(pixel(at.x, at.y), pixel(at.x + reach * std::cos(at.theta), at.y + reach * std::sin(at.theta)));
    QTRY_VERIFY2(message().startsWith("Placed at"), qPrintable(message()));
    QVERIFY(view().tool() == MapView::Tool::Pan);
    QTRY_COMPARE(model().outcome(), QString("matched"));
    QVERIFY(std::hypot(model().pose()->x - at.x, model().pose()->y - at.y) < 0.2);
}

void TestMapPanel::exported_data() {
    QTest::addColumn<QString>("name");
    QTest::newRow("svg") << "view.svg";
    QTest::newRow("png") << "view.png";
}

void TestMapPanel::exported() {
    QFETCH(QString, name);
    const QString file = robot_->path(name);
    QVERIFY(panel()->exportTo(file).ok());
    if (name.endsWith("png")) {
        const QImage picture(file);
        QCOMPARE(picture.size(), view().size());
        QVERIFY(picture.convertToFormat(QImage::Format_Indexed8).colorCount() > 3); // not one blank sheet
        return;
    }
    QFile text(file);
    QVERIFY(text.open(QIODevice::ReadOnly));
    QXmlStreamReader xml(&text);
    int lines = 0;
    while (!xml.atEnd())
        lines += xml.readNext() == QXmlStreamReader::StartElement && xml.name() == "polyline";
    QVERIFY2(!xml.hasError(), qPrintable(xml.errorString()));
    QVERIFY(lines >= model().edges().size());
}

void TestMapPanel::exportThatFails() {
    for (const char *const name : {"nowhere/view.svg", "nowhere/view.png"}) {
        const auto done = panel()->exportTo(robot_->path(name));
        QVERIFY(!done.ok());
        QVERIFY(done.error().message.contains(name));
    }
}

void TestMapPanel::savedByCommand() {
    QVERIFY(window_->choose(window_->fleet.robot()->withName("scanmatcher")));
    auto *const commands = window_->panel<CommandsPanel>("commands");
    auto *const methods = commands->findChild<QListWidget *>("methods");
    methods->setCurrentItem(methods->findItems("map.save", Qt::MatchExactly).value(0));
    const QString file = robot_->path("maps/saved.csv");
    OpenWindow::type(commands->findChild<QWidget *>("path")->findChild<QLineEdit *>(), file);
    OpenWindow::click(commands, "call");
    QTRY_VERIFY2(QFileInfo(file).size() > 1000,
                 qPrintable(commands->findChild<QPlainTextEdit *>("answer")->toPlainText()));
}

void TestMapPanel::twoClicksSaveIt() {
    auto *const button = panel()->findChild<QToolButton *>("mapMenu");
    auto *const save = panel()->findChild<QAction *>("saveMap");
    QTimer second;
    connect(&second, &QTimer::timeout, this, [&] {
        QMenu *const menu = button->menu();
        if (!menu->isVisible())
            return;
        second.stop();
        QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(save).center());
    });
    second.start(50);
    QTest::mouseClick(button, Qt::LeftButton); // returns when the menu is closed
    QTRY_VERIFY2(message().contains(QRegularExpression("walls to .*/map-20[0-9-]*\\.csv on the robot")),
                 qPrintable(message()));
}

void TestMapPanel::mapsByTheMenu() {
    const auto trigger = [this](const QString &name) {
        auto *const action = panel()->findChild<QAction *>(name);
        QVERIFY2(action && action->isEnabled(), qPrintable(name));
        action->trigger();
    };
    const auto accept = [] { // in the dialog that has opened
        QPushButton *button = nullptr;
        QTRY_VERIFY([&] {
            for (QWidget *window : QApplication::topLevelWidgets())
                if (qobject_cast<QDialog *>(window) && window->isVisible())
                    button = window->findChild<QPushButton *>("accept");
            return button != nullptr;
        }());
        QVERIFY(!button->window()->isModal());
        button->click();
    };
    const int walls = model().edges().size();
    QVERIFY(walls > 0);
    panel()->findChild<QLabel *>("message")->clear();
    trigger("saveMap"); // of the last case: asks whether to replace it
    accept();
    QTRY_VERIFY2(message().contains(".csv on the robot"), qPrintable(message()));
    trigger("newMap");
    QTest::qWait(100);
    QVERIFY(!model().edges().isEmpty()); // it asks
    accept();
    QTRY_VERIFY2(message().startsWith("A new map has begun"), qPrintable(message()));
    trigger("undoMap");
    QTRY_VERIFY2(message().startsWith("The map before is back"), qPrintable(message()));
    QTRY_VERIFY(model().edges().size() >= walls);
    trigger("localization");
    QTRY_COMPARE(message(), QString("The map stays as it is."));
    QTRY_VERIFY(panel()->findChild<QAction *>("localization")->isChecked());
    trigger("openMap");
    accept(); // the newest
    QTRY_VERIFY2(message().startsWith("Opened map-20"), qPrintable(message()));
    QTRY_COMPARE(model().edges().size(), walls);
    trigger("saveMapAs");
    accept();
    accept(); // it exists: asks whether to replace it
    QTRY_VERIFY2(message().contains(".csv on the robot"), qPrintable(message()));
    trigger("mapping");
    QTRY_COMPARE(message(), QString("The map grows."));
}

void TestMapPanel::matcherGoneAndBack() {
    robot_->kill("scanmatcher");
    QTRY_VERIFY(!panel()->findChild<QAction *>("place")->isEnabled());
    robot_->start("scanmatcher",
                  {QString("source.address=127.0.0.1:%1").arg(robot_->port("velodynelogger"))});
    QTRY_VERIFY_WITH_TIMEOUT(panel()->findChild<QAction *>("place")->isEnabled(), 10000);
    QTRY_VERIFY_WITH_TIMEOUT(model().edges().size() > 10, 10000);
    // The map of the new one replaces that of the old one; without scans it stands still, to be compared.
    robot_->kill("simulator");
    Client client;
    client.connectTo(QString("127.0.0.1:%1").arg(robot_->port("scanmatcher")));
    QVERIFY(client.waitConnected().ok());
    int there = -1, shown = -1;
    const auto areAlike = [&] {
        const auto map = client.callAndWait("map.get");
        there = map ? (*map)["edges"].toArray().size() : -1;
        shown = int(model().edges().size());
        return there == shown;
    };
    QTRY_VERIFY2_WITH_TIMEOUT(areAlike(), qPrintable(QString("%1 shown of %2").arg(shown).arg(there)), 10000);
}

QTEST_MAIN(TestMapPanel)
#include "TestMapPanel.moc"
