#include "gui/desktop/panels/CommandsPanel.h"
#include "tests/gui/desktop/MapWindow.h"

#include <QDialog>
#include <QFileInfo>
#include <QXmlStreamReader>

using namespace hermes;

/// The tools of the map: measured, placed, exported, saved and opened.
class TestMapPanel : public QObject, protected MapWindow {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { open(); }

    void measured() {
        tool("fit");
        tool("measure");
        drag(pixel(0, 0), pixel(3, 4));
        QVERIFY2(std::abs(message().section(' ', 0, 0).toDouble() - 5) < 2 / scale() + 1e-3,
                 qPrintable(message()));
        const QPoint from = pixel(0, 0), to = pixel(3, 4); // let go farther on than it was dragged to
        QTest::mousePress(&view(), Qt::LeftButton, {}, from);
        QMouseEvent move(QEvent::MouseMove, (from + to) / 2, Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(&view(), &move);
        QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
        QVERIFY2(std::abs(message().section(' ', 0, 0).toDouble() - 5) < 2 / scale() + 1e-3,
                 qPrintable(message())); // as the line that stays
        tool("measure");                 // off again
        QVERIFY(view().tool() == MapView::Tool::Pan);
    }

    void placedByADrag() {
        const Pose2D at = *model().pose();
        const double reach = 40 / scale();
        tool("place");
        drag(pixel(at.x, at.y), pixel(at.x + reach * std::cos(at.theta), at.y + reach * std::sin(at.theta)));
        TRY_STARTS(message(), "Placed at");
        QVERIFY(view().tool() == MapView::Tool::Pan);
        QTRY_COMPARE(model().outcome(), QString("matched"));
        QVERIFY(std::hypot(model().pose()->x - at.x, model().pose()->y - at.y) < 0.2);
    }

    void exported_data() {
        const Rows<QString> row("name");
        row("svg", "view.svg");
        row("png", "view.png");
    }

    void exported() {
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

    void exportThatFails() {
        for (const char *const name : {"nowhere/view.svg", "nowhere/view.png"}) {
            const auto done = panel()->exportTo(robot_->path(name));
            QVERIFY(!done.ok());
            QVERIFY(done.error().message.contains(name));
        }
    }

    void savedByCommand() {
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

    void twoClicksSaveIt() {
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
        TRY_CONTAINS(message(), QRegularExpression("walls to .*/map-20[0-9-]*\\.csv on the robot"));
    }

    void mapsByTheMenu() {
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
        panel()->findChild<QLabel *>("message")->clear();
        trigger("saveMap"); // of the last case: asks whether to replace it
        accept();
        TRY_CONTAINS(message(), ".csv on the robot");
        const int walls = QRegularExpression("(\\d+) walls").match(message()).captured(1).toInt();
        QVERIFY2(walls > 0, qPrintable(message()));
        trigger("newMap");
        QTest::qWait(100);
        QVERIFY(!model().edges().isEmpty()); // it asks
        accept();
        TRY_STARTS(message(), "A new map has begun");
        trigger("undoMap");
        TRY_STARTS(message(), "Undone: New map. The map has ");
        QTRY_COMPARE(panel()->findChild<QAction *>("redoMap")->text(), QString("&Redo New map"));
        QTRY_VERIFY(model().edges().size() >= walls);
        trigger("localization");
        QTRY_COMPARE(message(), QString("The map stays as it is."));
        QTRY_VERIFY(panel()->findChild<QAction *>("localization")->isChecked());
        trigger("openMap");
        accept(); // the newest
        TRY_STARTS(message(), "Opened map-20");
        QTRY_COMPARE(model().edges().size(), walls);
        trigger("saveMapAs");
        accept();
        accept(); // it exists: asks whether to replace it
        TRY_CONTAINS(message(), ".csv on the robot");
        trigger("mapping");
        QTRY_COMPARE(message(), QString("The map grows."));

        const Pose2D at = *model().pose();
        Q_EMIT view().placed({at.x + 3, at.y, at.theta + 1}); // where the scans do not agree
        QTRY_VERIFY2(message().startsWith("Placed at"), qPrintable(message()));
        auto *const menu = panel()->findChild<QToolButton *>("mapMenu")->menu();
        Q_EMIT menu->aboutToShow();
        trigger("confirmPlace");
        accept();
        QTRY_VERIFY2(message().startsWith("The place is confirmed."), qPrintable(message()));
        const auto *const confirm = panel()->findChild<QAction *>("confirmPlace");
        bool isKnown = false;
        const auto looks = [&] { // by the answer before; the matcher may be at a scan still
            isKnown = isKnown || !confirm->isEnabled();
            if (!isKnown)
                Q_EMIT menu->aboutToShow();
            return isKnown;
        };
        Q_EMIT menu->aboutToShow();
        QTRY_VERIFY(looks());
        trigger("undoMap");
        QTRY_VERIFY2(message().startsWith("Undone: Place."), qPrintable(message()));
    }

    void matcherGoneAndBack() {
        robot_->kill("scanmatcher");
        QTRY_VERIFY(!panel()->findChild<QAction *>("place")->isEnabled());
        robot_->start("scanmatcher",
                      {QString("source.address=127.0.0.1:%1").arg(robot_->port("velodynelogger"))});
        QTRY_VERIFY_WITH_TIMEOUT(panel()->findChild<QAction *>("place")->isEnabled(), 10000);
        QTRY_VERIFY_WITH_TIMEOUT(model().edges().size() > 10, 10000);
        // The map of the new one replaces that of the old one; without scans it stands still, to be compared.
        robot_->kill("simulator");
        ConnectedClient client(QString("127.0.0.1:%1").arg(robot_->port("scanmatcher")));
        int there = -1, shown = -1;
        const auto areAlike = [&] {
            const auto map = client.callAndWait("map.get");
            there = map ? (*map)["edges"].toArray().size() : -1;
            shown = int(model().edges().size());
            return there == shown;
        };
        QTRY_VERIFY2_WITH_TIMEOUT(areAlike(), saying("%1 shown of %2", shown, there), 10000);
    }
};
