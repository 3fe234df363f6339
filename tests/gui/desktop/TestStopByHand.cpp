#include "gui/desktop/TopBar.h"
#include "gui/desktop/widgets/Typing.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

#include <QDialog>
#include <QMessageBox>

using namespace hermes;

/// STOP acts at once, whatever lies open in the window: with real keys and a real mouse (xdotool) on a
/// display with a window manager (with_display).
class TestStopByHand : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        robot_ = std::make_unique<FakeRobot>();
        open_ = std::make_unique<OpenWindow>(robot_->address());
        QVERIFY(open_->show());
        stop_ = open_->window.findChild<QPushButton *>("stop");
    }

    void init() {
        release();
        open_->window.activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(&open_->window));
        open_->window.centralWidget()->setFocus();
    }

    // The hands in turn at the menus and lists of one kind; at four of them, each release takes 2 s. With
    // HERMES_MENUS at all.
    void everyMenuAndList() {
        const auto hasList = [](QWidget *widget) {
            const auto *const list = qobject_cast<QComboBox *>(widget);
            const auto *const menu = qobject_cast<QToolButton *>(widget);
            return (list && list->count() > 0) || (menu && menu->menu());
        };
        const auto isPopupOpen = [] { return QApplication::activePopupWidget() != nullptr; };
        QMap<QString, int> counts; // by kind
        const auto isEnough = [&](const QString &kind) { return !isAll() && counts.value(kind) >= 4; };
        const auto kindOf = [](QWidget *widget) {
            return QString(qobject_cast<QComboBox *>(widget) ? "lists" : "menus");
        };
        const auto nextHand = [&counts](const QString &kind) { return allHands[counts[kind]++ % 3]; };
        QSet<QWidget *> seen;
        for (QDockWidget *dock : open_->window.findChildren<QDockWidget *>()) {
            dock->show();
            dock->raise();
            QTest::qWait(50);
            for (QWidget *widget : visible(hasList)) {
                if (seen.contains(widget) || isEnough(kindOf(widget)))
                    continue;
                seen.insert(widget);
                stopsWhileOpen(
                    widget->metaObject()->className() + (' ' + widget->objectName()),
                    [&] { click(middleOf(widget)); }, isPopupOpen, nextHand(kindOf(widget)));
                if (QTest::currentTestFailed())
                    return;
            }
            // The menu of a field, by the right button.
            for (QWidget *field :
                 visible([](QWidget *widget) { return qobject_cast<QLineEdit *>(widget); })) {
                if (isEnough("menus of fields"))
                    break;
                stopsWhileOpen(
                    "menu of " + field->objectName(), [&] { click(middleOf(field), 3); }, isPopupOpen,
                    nextHand("menus of fields"));
                if (QTest::currentTestFailed())
                    return;
                break; // they are all alike
            }
        }
        auto *const menus = open_->window.menuBar();
        for (QAction *menu : menus->actions()) {
            const QPoint middle = menus->mapToGlobal(menus->actionGeometry(menu).center());
            stopsWhileOpen(
                menu->text(), [middle] { click(middle); }, isPopupOpen, nextHand("menu bar"));
            if (QTest::currentTestFailed())
                return;
        }
        qInfo() << counts;
        QCOMPARE(counts.size(), 4);
        QVERIFY(*std::min_element(counts.begin(), counts.end()) >= 3);
    }

    void everyDialog_data() { hands(); }

    // One hand at each; with HERMES_MENUS all.
    void everyDialog() {
        QFETCH(QString, hand);
        int turn = allHands.indexOf(hand);
        const auto dialog = [] {
            return QApplication::activeWindow() && qobject_cast<QDialog *>(QApplication::activeWindow());
        };
        for (const char *name : {"export", "csv", "picture", "saveSet", "helpHere", "about"}) {
            if (!isAll() && turn++ % allHands.size() != 0)
                continue;
            if (name == QString("csv")) {
                auto *const dock = open_->window.findChild<QDockWidget *>("plots");
                dock->show();
                dock->raise();
            }
            auto *const button = open_->window.findChild<QAbstractButton *>(name);
            auto *const action = open_->window.findChild<QAction *>(name); // of a menu
            QVERIFY2(button || action, name);
            QTRY_VERIFY(!button || !button->visibleRegion().isEmpty());
            stopsWhileOpen(
                name, [&] { button ? click(middleOf(button)) : action->trigger(); },
                [&] {
                    if (!dialog())
                        return false;
                    // On a list of files or a button; in the field of the name it is text.
                    if (hand == "space")
                        for (auto *widget : QApplication::activeWindow()->findChildren<QWidget *>())
                            if (widget->isVisible() && (qobject_cast<QAbstractItemView *>(widget) ||
                                                        qobject_cast<QAbstractButton *>(widget)))
                                widget->setFocus();
                    return true;
                },
                hand);
            for (QWidget *window : QApplication::topLevelWidgets())
                if (qobject_cast<QDialog *>(window))
                    window->close();
            if (QTest::currentTestFailed())
                return;
            open_->window.activateWindow();
            QVERIFY(QTest::qWaitForWindowActive(&open_->window));
        }
    }

    void whetherToReplace_data() { hands(); }

    // The file dialog's own question would be modal, and the button out of reach.
    void whetherToReplace() {
        QFETCH(QString, hand);
        QTemporaryDir folder;
        QFile there(folder.filePath("map.svg"));
        QVERIFY(there.open(QIODevice::WriteOnly));
        const auto question = [this] {
            for (const auto *const box : open_->window.findChildren<QMessageBox *>())
                if (box->isVisible())
                    return true;
            return false;
        };
        stopsWhileOpen(
            "whether to replace",
            [&] {
                open_->window.findChild<QAction *>("export")->trigger();
                auto *const dialog = open_->window.findChild<QFileDialog *>();
                dialog->selectFile(there.fileName());
                QTimer::singleShot(300, dialog, [dialog] { QMetaObject::invokeMethod(dialog, "accept"); });
            },
            question, hand);
        for (auto *const box : open_->window.findChildren<QMessageBox *>())
            box->close();
        QCOMPARE(there.size(), 0LL); // it was not meant
    }

    void aToolTip_data() { hands(); }

    void aToolTip() {
        QFETCH(QString, hand);
        moveTo(middleOf(open_->window.centralWidget()));
        QTest::qWait(100);
        stopsWhileOpen(
            "tool tip", [&] { moveTo(middleOf(stop_)); }, [] { return QToolTip::isVisible(); }, hand);
    }

    // Each control of each panel has the focus once: Space and Esc are STOP there, Space not where one types.
    void everyFocus() {
        open_->window.findChild<QAction *>("escapeStops")->setChecked(true);
        int count = 0;
        QSet<QWidget *> seen; // most are beside each of the docks
        for (QDockWidget *dock : open_->window.findChildren<QDockWidget *>()) {
            dock->show();
            dock->raise();
            QTest::qWait(20);
            release(); // what a stop disables is seen
            for (QWidget *widget : visible([](QWidget *w) { return w->focusPolicy() & Qt::TabFocus; })) {
                if (seen.contains(widget))
                    continue;
                seen.insert(widget);
                for (const char *key : {"space", "Escape"}) {
                    if (!widget->isEnabled()) // while stopped
                        release();
                    widget->setFocus();
                    if (QApplication::focusWidget() != widget)
                        continue;
                    if (key == QString("space") && isTyping(widget))
                        continue;
                    const QSignalSpy stops(&open_->drive, &DriveControl::stopPressed);
                    xdotool("key", key);
                    QTRY_VERIFY2_WITH_TIMEOUT(
                        open_->drive.isStopped() && !stops.isEmpty(),
                        qPrintable(QString("%1 %2 %3")
                                       .arg(key, widget->metaObject()->className(), widget->objectName())),
                        2000);
                    ++count;
                }
                if (QTest::currentTestFailed())
                    return;
            }
        }
        release();
        qInfo("%d times", count);
        QVERIFY(count > 40);
    }

    void spaceIsTyped() {
        auto *const field = open_->window.findChild<QLineEdit *>("address");
        open_->window.findChild<QDockWidget *>("daemons")->raise();
        QTRY_VERIFY(!field->visibleRegion().isEmpty());
        field->clear();
        field->setFocus();
        xdotool("type", "a b");
        QTRY_COMPARE(field->text(), QString("a b"));
        QVERIFY(!open_->drive.isStopped());
        xdotool("key", "F12");
        QTRY_VERIFY(open_->drive.isStopped());
        release();
        field->clear();
    }

    void escapeCloses() {
        QToolButton *layers = nullptr;
        for (QToolButton *const button : open_->window.findChildren<QToolButton *>())
            if (button->menu() && !button->visibleRegion().isEmpty())
                layers = button;
        QVERIFY(layers);
        QTimer closing;
        bool wasOpen = false;
        connect(&closing, &QTimer::timeout, this, [&] {
            if (QApplication::activePopupWidget() && !std::exchange(wasOpen, true))
                xdotool("key", "Escape");
        });
        closing.start(20);
        click(middleOf(layers));
        QTRY_VERIFY_WITH_TIMEOUT(wasOpen && !QApplication::activePopupWidget(), 5000);
        QVERIFY(!open_->drive.isStopped());
    }

private:
    static inline const QStringList allHands{"mouse", "space", "F12"};

    static bool isAll() { return qEnvironmentVariableIsSet("HERMES_MENUS"); }
    static void hands() {
        const Rows<QString> row("hand");
        for (const QString &hand : allHands)
            row(qPrintable(hand), hand);
    }

    template <typename... Words>
    static void xdotool(const Words &...words) {
        QProcess::startDetached("xdotool", {QString(words)...}); // the event loop goes on, also in menus
    }
    static void moveTo(const QPoint &global) {
        xdotool("mousemove", QString::number(global.x()), QString::number(global.y()));
    }
    static void click(const QPoint &global, int button = 1) {
        xdotool("mousemove", QString::number(global.x()), QString::number(global.y()), "click",
                QString::number(button));
    }
    static QPoint middleOf(const QWidget *widget) { return widget->mapToGlobal(widget->rect().center()); }

    void stopBy(const QString &hand) {
        if (hand == "mouse")
            click(middleOf(stop_));
        else
            xdotool("key", hand);
    }

    /// Opens something, which may run an event loop of its own until it is closed, and stops while it is
    /// open.
    void stopsWhileOpen(const QString &what, const std::function<void()> &open,
                        const std::function<bool()> &isOpen, const QString &hand) {
        bool wasOpen = false;
        QElapsedTimer sinceStop;
        QTimer stopping, closing;
        stopping.start(20);
        connect(&stopping, &QTimer::timeout, this, [&] {
            if (wasOpen || !isOpen())
                return;
            wasOpen = true;
            stopping.stop();
            sinceStop.start();
            stopBy(hand);
        });
        closing.setSingleShot(true);
        connect(&closing, &QTimer::timeout, this, [] { // a failure is not to hang
            while (QWidget *const popup = QApplication::activePopupWidget())
                popup->hide();
        });
        closing.start(5000);
        QTimer opening; // a press that comes while the last menu closes is lost
        connect(&opening, &QTimer::timeout, this, [&] {
            if (!wasOpen)
                open();
        });
        opening.start(1000);
        open();
        QTRY_VERIFY2_WITH_TIMEOUT(open_->drive.isStopped(),
                                  qPrintable(what + (wasOpen ? " is open" : " did not open")), 6000);
        QVERIFY2(wasOpen, qPrintable(what + " did not open"));
        QVERIFY2(sinceStop.elapsed() < 2000, saying("%1: %2 ms", what, sinceStop.elapsed()));
        release();
    }

    void release() {
        QTRY_VERIFY_WITH_TIMEOUT(!QApplication::activePopupWidget(), 5000);
        if (open_->drive.isStopped()) {
            QTRY_COMPARE(int(open_->drive.stopping().phase()), int(StopPhase::Confirmed));
            open_->drive.release();
        }
        QTRY_VERIFY_WITH_TIMEOUT(!open_->drive.isStopped(), 5000);
        QTRY_VERIFY(!open_->window.findChild<QLabel *>("stopBanner")->isVisible());
        QTest::qWait(50); // all is where it was before
    }

    QWidgetList visible(const std::function<bool(QWidget *)> &isWanted) {
        QWidgetList found;
        for (QWidget *widget : open_->window.findChildren<QWidget *>())
            if (isWanted(widget) && widget->isEnabled() && !widget->visibleRegion().isEmpty() &&
                widget->visibleRegion().contains(widget->rect().center()))
                found.append(widget);
        return found;
    }

    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<OpenWindow> open_;
    QPushButton *stop_ = nullptr;
};
