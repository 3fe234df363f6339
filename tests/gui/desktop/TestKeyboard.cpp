#include "gui/desktop/MainWindow.h"
#include "gui/desktop/widgets/Banner.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QSplitter>

using namespace hermes;
using namespace hermes::desktop;

/// It, or what covers all of it and belongs to it.
static bool isInSight(const QWidget &widget) {
    const auto inner = widget.findChildren<QWidget *>(QString(), Qt::FindDirectChildrenOnly);
    return !widget.visibleRegion().isEmpty() ||
           std::any_of(inner.begin(), inner.end(), [](const QWidget *part) { return isInSight(*part); });
}

/// Everything in the window is within reach of the keyboard.
class TestKeyboard : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        fleet_ = std::make_unique<Fleet>();
        drive_ = std::make_unique<DriveControl>(*fleet_);
        window_ = std::make_unique<MainWindow>(*fleet_, *drive_, QString());
        window_->show();
        window_->activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(window_.get()));
    }

    void cleanup() {
        window_.reset();
        drive_.reset();
        fleet_.reset();
    }

    void mnemonicsAreUnique() {
        QMap<QString, QString> owners;
        const auto add = [&owners](const QString &text) {
            const QString keys = QKeySequence::mnemonic(text).toString();
            if (keys.isEmpty())
                return;
            QVERIFY2(!owners.contains(keys), qPrintable(keys + ": " + owners.value(keys) + " and " + text));
            owners[keys] = text;
        };
        for (const auto *button : window_->findChildren<QAbstractButton *>())
            add(button->text());
        for (const auto *label : window_->findChildren<QLabel *>())
            if (label->buddy())
                add(label->text());
        QVERIFY(owners.size() > 10);
    }

    void everyControlIsInTheTabOrder() {
        QSet<QWidget *> reached;
        for (QWidget *next = window_->nextInFocusChain(); next != window_.get();
             next = next->nextInFocusChain())
            reached.insert(next);
        QWidgetList controls;
        for (auto *button : window_->findChildren<QAbstractButton *>())
            controls.append(button);
        for (auto *field : window_->findChildren<QLineEdit *>())
            controls.append(field);
        for (auto *choice : window_->findChildren<QComboBox *>())
            controls.append(choice);
        for (auto *view : window_->findChildren<QAbstractItemView *>())
            controls.append(view);
        int count = 0;
        for (QWidget *control : qAsConst(controls)) {
            const QString name = control->objectName();
            // STOP has Space and Esc; those of Qt are parts of other controls.
            if (name == "stop" || name.startsWith("qt_") || !control->parentWidget() ||
                control->inherits("QHeaderView") || control->inherits("QComboBoxListView") ||
                qobject_cast<QDockWidget *>(control->parentWidget()) ||
                control->inherits("QLineEditIconButton"))
                continue;
            const QString who = QString("%1 %2").arg(control->metaObject()->className(), name);
            QVERIFY2(reached.contains(control), qPrintable(who));
            QVERIFY2(control->focusPolicy() & Qt::TabFocus, qPrintable(who));
            ++count;
        }
        QVERIFY(count > 25);
    }

    void tabLeadsToWhatIsSeen_data() {
        const Rows<QString, QString> row("front", "other");
        for (const char *const front : {"daemons", "settings", "commands", "log", "plots", "drive",
                                        "recordings", "setup", "events", "cloud"})
            QTest::addRow("%s in front", front) << front << QString();
        row("one floats", "recordings", "floating");
        row("parts are drawn shut", "commands", "shut");
        row("low", "settings", "low");
    }

    // Forward and back, until it is where it began.
    void tabLeadsToWhatIsSeen() {
        FETCH(QString, front, QString, other);
        auto *const dock = window_->findChild<QDockWidget *>(front);
        dock->raise();
        dock->setFloating(other == "floating");
        if (other == "shut")
            for (auto *const splitter : dock->findChildren<QSplitter *>())
                splitter->setSizes(QList<int>{0} + QVector<int>(splitter->count() - 1, 200).toList());
        if (other == "low")
            window_->resize(1024, 600);
        window_->activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(window_.get()));
        for (const Qt::Key key : {Qt::Key_Tab, Qt::Key_Backtab}) {
            window_->centralWidget()->setFocus();
            QWidget *const first = QApplication::focusWidget();
            int count = 0;
            do {
                QTest::keyClick(QApplication::focusWidget(), key);
                const QWidget *const focus = QApplication::focusWidget();
                QVERIFY2(focus && isInSight(*focus),
                         qPrintable(focus ? focus->metaObject()->className() + focus->objectName() : "none"));
                QVERIFY(++count < 500);
            } while (QApplication::focusWidget() != first);
            QVERIFY2(count > 10, saying(count));
        }
    }

    void whatIsOutOfSightGetsNoKeys() {
        auto *const recordings = window_->findChild<QDockWidget *>("recordings");
        auto *const field = window_->findChild<QDockWidget *>("log")->findChild<QLineEdit *>("filter");
        window_->findChild<QDockWidget *>("log")->raise();
        field->setFocus();
        window_->findChild<QDockWidget *>("plots")->raise(); // by its tab
        QVERIFY(QApplication::focusWidget() != field);
        field->setFocus(); // whatever does it
        QTest::keyClick(field, Qt::Key_X);
        QCOMPARE(field->text(), QString());
        QVERIFY(QApplication::focusWidget() != field);

        window_->findChild<QDockWidget *>("drive")->raise(); // behind it is Record
        auto *const button = new QPushButton("Press &9", recordings->findChild<QScrollArea *>()->widget());
        button->show();
        QSignalSpy clicked(button, &QPushButton::clicked);
        button->setFocus();
        QTest::keyClick(button, Qt::Key_Return);
        QTest::keyClick(window_.get(), Qt::Key_9, Qt::AltModifier);
        QVERIFY(!button->isDown()); // else it would click a moment later
        QCOMPARE(clicked.count(), 0);
        recordings->raise();
        QTRY_VERIFY(!button->visibleRegion().isEmpty());
        QTest::keyClick(window_.get(), Qt::Key_9, Qt::AltModifier);
        QTRY_COMPARE(clicked.count(), 1);
    }

    void docksComeByNumber() {
        const auto docks = window_->findChildren<QDockWidget *>(QString(), Qt::FindDirectChildrenOnly);
        QVERIFY(docks.size() >= 6);
        QSet<QString> seen;
        for (int number = 1; number <= docks.size(); ++number) {
            QTest::keyClick(window_.get(), Qt::Key(Qt::Key_0 + number % 10), Qt::ControlModifier);
            QWidget *const focus = QApplication::focusWidget();
            QVERIFY2(focus, saying(number));
            for (const QDockWidget *dock : docks)
                if (dock->isAncestorOf(focus) && !dock->visibleRegion().isEmpty()) {
                    seen.insert(dock->objectName());
                    QVERIFY2(focus->focusPolicy() & Qt::TabFocus, qPrintable(dock->objectName()));
                }
            if (number == 1)
                QVERIFY2(focus->objectName() == "tree", qPrintable(focus->objectName()));
            if (number == 6) // the keys drive
                QVERIFY(window_->centralWidget()->isAncestorOf(focus));
        }
        QCOMPARE(seen.size(), docks.size() - 1);
    }

    // A minute later; here at once.
    void whatWasToldHasItsTime() {
        auto *const panel = window_->findChild<QDockWidget *>("daemons");
        auto *const message = panel->findChild<QLabel *>("message");
        panel->findChild<QLineEdit *>("address")->setText("999.1.1.1");
        panel->findChild<QPushButton *>("add")->click();
        const QString told = message->text();
        QVERIFY2(told.contains("999.1.1.1") && message->isEnabled(), qPrintable(told));
        auto *const old = message->findChild<QTimer *>();
        QVERIFY(old->isActive() && old->interval() >= 10000);
        old->start(0);
        QTRY_VERIFY(!message->isEnabled());
        QVERIFY2(QRegularExpression("^\\d\\d:\\d\\d:\\d\\d  ").match(message->text()).hasMatch() &&
                     message->text().endsWith(told),
                 qPrintable(message->text()));
    }

    void keysThatDriveNothingAreTold() {
        QTest::keyClick(window_.get(), Qt::Key_1, Qt::ControlModifier); // the list of daemons
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_Down);     // is for it
        QVERIFY(!QToolTip::text().contains("Ctrl+6"));
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_W);
        VERIFY_CONTAINS(QToolTip::text(), "Ctrl+6");
    }

    void enterPressesAndTicks() {
        auto *const follow = window_->findChild<QAction *>("follow");
        QWidget *button = nullptr;
        for (auto *candidate : window_->findChildren<QAbstractButton *>())
            if (candidate->actions().contains(follow))
                button = candidate;
        QVERIFY(button);
        const bool before = follow->isChecked();
        button->setFocus();
        QTest::keyClick(button, Qt::Key_Return);
        QCOMPARE(follow->isChecked(), !before);

        auto *const topics = window_->findChild<QTreeWidget *>("topics");
        auto *const item = new QTreeWidgetItem(topics, {"number"});
        item->setCheckState(0, Qt::Unchecked);
        topics->setCurrentItem(item);
        QTest::keyClick(topics, Qt::Key_Return);
        QCOMPARE(item->checkState(0), Qt::Checked);
        QTest::keyClick(topics, Qt::Key_Space); // STOP, not a tick
        QCOMPARE(item->checkState(0), Qt::Checked);
    }

    void bannersFitALowScreen() {
        window_->resize(1024, 600);
        QTest::qWait(100);           // it is laid out
        const auto places = [this] { // of what is clicked at
            QVector<QRect> found;
            for (const char *const name : {"tree", "stick", "robots", "map"}) {
                const auto *const widget = window_->findChild<QWidget *>(name);
                found.append({widget->mapTo(window_.get(), QPoint()), QSize()});
            }
            return found;
        };
        const auto before = places();
        for (const char *const name : {"replayBanner", "noticeBanner"}) {
            auto *const banner = static_cast<Banner *>(window_->findChild<QLabel *>(name));
            banner->resize(100, 30); // as one is that was never seen
            banner->tell(QString("Words and more words. ").repeated(6), {});
            QTRY_VERIFY(banner->isVisible() && banner->width() > 900);
            QTest::qWait(100); // the window may answer later
            QVERIFY2(window_->height() == 600, saying(window_->height()));
            QCOMPARE(places(), before);
        }
    }

private:
    std::unique_ptr<Fleet> fleet_;
    std::unique_ptr<DriveControl> drive_;
    std::unique_ptr<MainWindow> window_;
};
