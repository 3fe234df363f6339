#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/view/CloudView.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// No value of a daemon that is frozen looks alive for longer than a second, in whichever panel it stands:
/// what had changed again and again, and does not any more, is grey or struck out.
class TestFrozenDaemons : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAllWithGps();
        robot_->start("softwaretrigger");
        robot_->supervise("robot");
        open_ = std::make_unique<OpenWindow>(*robot_);
        open_->window.resize(1280, 720);
        QVERIFY(open_->show());
        for (auto *const dock : open_->window.findChildren<QDockWidget *>()) {
            dock->setFloating(true); // all are in sight at the same time
            dock->resize(900, 500);
            dock->show();
        }
        open_->window.activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(&open_->window));
        QTRY_VERIFY_WITH_TIMEOUT(open_->window.map().model().pose(), 20000);
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        QTRY_VERIFY_WITH_TIMEOUT(
            open_->window.findChild<CloudView *>()->isVisible() &&
                open_->window.findChild<QLabel *>("cloudSummary")->text().contains("points"),
            10000);
        for (auto *const tree : open_->window.findChildren<QTreeWidget *>())
            tree->expandAll();
    }

    void oneInTurn_data() {
        rowsOf("who", {"motorcontrol", "scanmatcher", "velodynelogger", "seriallogger", "simulator",
                       "softwaretrigger", "supervisor"});
    }

    void oneInTurn() {
        QFETCH(QString, who);
        QVERIFY(open_->choose(open_->fleet.robot()->withName(who)));
        QTest::keyPress(&open_->window, Qt::Key_Q); // on the spot
        QMap<QString, int> changes;
        QTest::qWait(1000);
        Values last = values();
        for (int i = 0; i < 20; ++i) {
            QTest::qWait(100);
            const Values now = values();
            for (auto value = now.begin(); value != now.end(); ++value)
                changes[value.key()] += last.contains(value.key()) && last[value.key()].text != value->text;
            last = now;
        }
        robot_->signal(who, SIGSTOP);
        auto frozen = runningTimer();
        QTest::qWait(1000);
        const Values atOnce = values();
        grabAll(who);
        QStringList faults;
        QSet<QString> still; // while the others change
        for (auto value = atOnce.begin(); value != atOnce.end(); ++value)
            if (value->looksAlive && changes[value.key()] >= often && !isOfAnother(value.key(), who))
                still.insert(value.key());
        while (frozen.elapsed() < 3500) {
            QTest::qWait(100);
            const Values now = values();
            for (auto value = now.begin(); value != now.end(); ++value) {
                const Value &before = atOnce.value(value.key());
                if (before.text != value->text)
                    still.remove(value.key());
                if (before.looksAlive && last.value(value.key()).looksAlive && !value->looksAlive &&
                    !isOfAnother(value.key(), who))
                    faults.append(QString("%1: %2, late, after %3 ms")
                                      .arg(value.key(), before.text)
                                      .arg(frozen.elapsed()));
            }
        }
        QTest::keyRelease(&open_->window, Qt::Key_Q);
        robot_->signal(who, SIGCONT);
        for (const QString &key : qAsConst(still))
            faults.append(key + ": " + atOnce.value(key).text + ", as if alive");
        faults.removeDuplicates();
        QVERIFY(std::count_if(changes.begin(), changes.end(), [](int count) { return count >= often; }) > 5);
        QVERIFY2(faults.isEmpty(), qPrintable(faults.join("\n")));
        QTRY_VERIFY_WITH_TIMEOUT(open_->fleet.robot()->withName(who)->condition() != Condition::Unreachable,
                                 5000);
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        QTest::qWait(500);
        grabAll(who + "-back");
    }

private:
    static constexpr int often = 8; // of the 20 times that one looks

    struct Value {
        QString text;
        bool looksAlive = true;
    };
    using Values = QMap<QString, Value>; // by where it stands

    Values values() const {
        Values all;
        for (const QDockWidget *dock : open_->window.findChildren<QDockWidget *>()) {
            addLabels(dock, dock->objectName(), all);
            for (const QAbstractItemView *view : dock->findChildren<QAbstractItemView *>())
                if (view->isVisible() && view->model())
                    addCells(view, dock->objectName(), all);
        }
        addLabels(&open_->window, "window", all);
        return all;
    }

    void addLabels(const QWidget *panel, const QString &where, Values &all) const {
        for (const QLabel *label : panel->findChildren<QLabel *>())
            if (label->isVisible() && !label->text().isEmpty())
                all.insert(where + '/' + label->objectName() + QString::number(quintptr(label), 16),
                           {label->text(), label->isEnabled() && !label->font().strikeOut()});
    }

    void addCells(const QAbstractItemView *view, const QString &where, Values &all) const {
        const QAbstractItemModel &model = *view->model();
        const QColor grey = view->palette().color(QPalette::Disabled, QPalette::Text);
        const std::function<void(const QModelIndex &, const QString &)> walk = [&](const QModelIndex &parent,
                                                                                   const QString &path) {
            for (int row = 0; row < model.rowCount(parent); ++row) {
                const QString name = path + '/' + model.index(row, 0, parent).data().toString();
                for (int column = 1; column < model.columnCount(parent); ++column) {
                    const QModelIndex cell = model.index(row, column, parent);
                    const QVariant brush = cell.data(Qt::ForegroundRole);
                    const bool isGrey = brush.isValid() && brush.value<QBrush>().color() == grey;
                    all.insert(name + '/' + QString::number(column),
                               {cell.data().toString(), view->isEnabled() && !isGrey});
                }
                walk(model.index(row, 0, parent), name);
            }
        };
        walk({}, where + '/' + view->objectName());
    }

    /// Not of the daemon that is frozen.
    bool isOfAnother(const QString &key, const QString &frozen) const {
        if (key.startsWith("drive/measured"))
            return frozen != "motorcontrol";
        const auto daemons = open_->fleet.robot()->daemons();
        return std::any_of(daemons.begin(), daemons.end(), [&](const DaemonLink *daemon) {
            return daemon->name() != frozen && key.contains('/' + daemon->name() + '/');
        });
    }

    void grabAll(const QString &name) const {
        const QString folder = qEnvironmentVariable("HERMES_PICTURES"); // for a person to look at
        if (folder.isEmpty())
            return;
        open_->window.grab().save(folder + '/' + name + "-window.png");
        for (QDockWidget *dock : open_->window.findChildren<QDockWidget *>())
            dock->grab().save(folder + '/' + name + '-' + dock->objectName() + ".png");
    }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
};
