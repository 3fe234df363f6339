#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/LayoutWindow.h"

using namespace hermes;

/// Layouts of the window and robots, kept in a file.
class TestLayouts : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("new/gui.json");
    }

    void savedSwitchedAndDeletedByHand() {
        const QJsonObject plotted{{"daemon", "127.0.0.1:1"}, {"topic", "a"}, {"field", "b"}};
        {
            LayoutWindow one(file_, {"127.0.0.1:1"});
            QVERIFY(one.dock("drive")->isVisible());
            one.saveAs("Bench & desk");
            one.dock("drive")->hide();
            one.window->findChild<PlotsPanel *>()->setState({{"panes", QJsonArray{QJsonArray{plotted}}}});
            one.pick("layout Usual");
            QTRY_VERIFY(one.dock("drive")->isVisible());
            QVERIFY(one.plots().isEmpty()); // they are of the other one
            one.pick("layout Bench & desk");
            QTRY_VERIFY(!one.dock("drive")->isVisible());
            one.window->close();
        }
        LayoutWindow next(file_);
        QVERIFY(!next.dock("drive")->isVisible());
        QCOMPARE(next.window->layouts().names(), QStringList({"Usual", "Bench & desk"}));
        QCOMPARE(next.window->layouts().current(), QString("Bench & desk"));
        QCOMPARE(next.plots(), QJsonArray{plotted});
        next.pick("resetLayout");
        QTRY_VERIFY(next.dock("drive")->isVisible());
        next.pick("removeLayout");
        QCOMPARE(next.window->layouts().names(), QStringList("Usual"));
        Q_EMIT next.menu().aboutToShow();
        auto *const removal =
            qobject_cast<QMenu *>(next.menu().findChild<QAction *>("removeLayout")->parent());
        QVERIFY(removal && !removal->menuAction()->isEnabled()); // the last
        QCOMPARE(next.notice(), QString());
    }

    void badNamesAreTold() {
        LayoutWindow one(file_, {"127.0.0.1:1"});
        one.saveAs("  ");
        QCOMPARE(one.notice(), QString("A layout needs a name."));
        one.saveAs("Usual");
        QCOMPARE(one.notice(), QString("There is a layout Usual already."));
        for (int i = 1; i < Layouts::most; ++i)
            one.saveAs(QString("%1\n\u202e").arg(i) + QString(10000, 'x'));
        QCOMPARE(one.window->layouts().names().size(), Layouts::most);
        one.saveAs("one more");
        VERIFY_STARTS(one.notice(), "There are 50 layouts");
        for (const QString &name : one.window->layouts().names())
            QVERIFY(name.size() <= Layouts::longestName && !name.contains('\n'));
    }

    void switchingDropsNoConnectionAndNoBanner() {
        Mischief motors;
        motors.isMotors = true;
        motors.hasTopics = false;
        const FakeDaemon daemon(motors);
        LayoutWindow one(file_, {daemon.address()});
        QTRY_VERIFY(one.drive->isPossible());
        one.saveAs("other");
        DaemonLink *const link = one.fleet.robot()->daemons().front();
        QSignalSpy lost(&link->client(), &Client::disconnected);
        one.drive->stop();
        auto *const banner = one.window->findChild<QLabel *>("stopBanner");
        QTRY_VERIFY(banner->isVisible());
        for (const char *const next : {"layout Usual", "layout other", "resetLayout", "removeLayout"}) {
            one.pick(next); // in none of which there was a banner when it was kept
            QVERIFY2(banner->isVisible() && one.isWhole(), next);
            QVERIFY(one.drive->isStopped());
        }
        QCOMPARE(lost.count(), 0);
        QVERIFY(link->isConnected());
    }

    void robotsAreKept() {
        Mischief supervisor;
        supervisor.topics["processes"] = R"({"robot":"rover","processes":[]})";
        const FakeDaemon one(supervisor), other(supervisor);
        {
            LayoutWindow first(file_, {one.address(), other.address()});
            QTRY_VERIFY(first.fleet.robotAt(one.address()) && first.fleet.robotAt(other.address()));
            first.fleet.rename(*first.fleet.robotAt(other.address()), "Blue, \"the\" second; [x]");
            first.fleet.choose(first.fleet.robotAt(other.address()));
            first.saveAs("desk");
            QTRY_COMPARE(Layouts(file_).robots().names.size(), 1); // before it is closed
        }
        LayoutWindow next(file_);
        QTRY_VERIFY(next.fleet.robotAt(other.address()) && next.fleet.robotAt(one.address()));
        QCOMPARE(next.fleet.robot(), next.fleet.robotAt(other.address()));
        QCOMPARE(next.fleet.robot()->name(), QString("Blue, \"the\" second; [x]"));
        next.pick("layout Usual");
        QCOMPARE(int(next.fleet.robots().size()), 2); // robots are of no layout
        QCOMPARE(next.window->findChild<QComboBox *>("robots")->currentText(), next.fleet.robot()->name());
    }

    // By its button it would lie exactly where it was.
    void floatingPanelIsSeenToFloat() {
        LayoutWindow first(file_);
        auto *const dock = static_cast<QDockWidget *>(first.dock("daemons"));
        const QPoint docked = dock->mapToGlobal(QPoint());
        dock->setFloating(true); // as its button does
        const QPoint moved = dock->pos() - docked;
        QVERIFY2(moved.manhattanLength() >= 40, saying("%1, %2", moved.x(), moved.y()));
        const QPoint place = dock->pos();
        dock->setFloating(false);
        dock->setFloating(true);
        QCOMPARE(dock->pos(), place); // it does not wander
        first.window->close();
        LayoutWindow again(file_);
        QCOMPARE(again.dock("daemons")->pos(), place);
        QVERIFY(again.dock("daemons")->isWindow() && again.dock("daemons")->isVisible());
    }

private:
    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
};
