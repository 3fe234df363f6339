#include "gui/desktop/model/Macro.h"
#include "gui/desktop/panels/EventsPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/PlotSets.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/LayoutWindow.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

using Set = std::function<void(LayoutWindow &)>;
using IsKept = std::function<bool(const QString &file)>;
Q_DECLARE_METATYPE(Set)
Q_DECLARE_METATYPE(IsKept)

/// What the operator has set is kept when the process is killed a second later.
class TestKept : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("gui.json");
        Layouts layouts(file_);
        layouts.setValue("buttons", R"([{"name":"Home","steps":[{"method":"motor.stop"}]}])");
        QVERIFY(layouts.save().ok());
    }

    void whatIsSetOutlivesAKill() {
        if (qEnvironmentVariableIsSet(ofChild)) { // the one that is killed
            const FakeDaemon daemon(rover());
            LayoutWindow one(qEnvironmentVariable(ofChild), {daemon.address()});
            setAll(one);
            QTest::qWait(1000);
            ::raise(SIGKILL);
        }
        QProcess child;
        QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
        environment.insert(ofChild, file_);
        child.setProcessEnvironment(environment);
        child.setProcessChannelMode(QProcess::MergedChannels);
        child.start(QCoreApplication::applicationFilePath(), {"whatIsSetOutlivesAKill"});
        QVERIFY(child.waitForFinished(60000));
        QVERIFY2(child.exitStatus() == QProcess::CrashExit, child.readAll().constData());

        LayoutWindow next(file_);
        QCOMPARE(next.notice(), QString());
        QCOMPARE(next.window->layouts().names(), QStringList({"Usual", "Field"}));
        QCOMPARE(next.window->layouts().current(), QString("Field"));
        QCOMPARE(next.window->layouts().robots().names.values(), QStringList("Blue"));
        QCOMPARE(next.window->layouts().robots().addresses.size(), 1);
        QTRY_COMPARE(next.window->size(), QSize(1180, 690));
        QVERIFY(!next.dock("drive")->isVisible());
        QTRY_VERIFY(isInFront(next, "events"));
        QCOMPARE(next.plots().size(), 1);
        QVERIFY(next.window->findChild<PlotsPanel *>()->sets().sets().contains("Wheels"));
        QVERIFY(!next.window->findChild<QAction *>("gridLayer")->isChecked());
        QVERIFY(next.window->findChild<QAction *>("escapeStops")->isChecked());
        QVERIFY(!next.window->findChild<QCheckBox *>("sounds")->isChecked());
        QTRY_COMPARE(next.window->findChild<QPushButton *>("macro0")->text().section(" (", 0, 0),
                     QString("Go home"));
    }

    // Nothing waits for something else to be saved.
    void eachByItself_data() {
        const Rows<Set, IsKept> row("set", "isKept");
        const auto trigger = [](const char *action) -> Set {
            return [action](LayoutWindow &one) { one.window->findChild<QAction *>(action)->trigger(); };
        };
        row("Esc", trigger("escapeStops"), [](const QString &file) { return value(file, "escape") == "on"; });
        row("layer", trigger("trustLayer"),
            [](const QString &file) { return value(file, "layers").contains("\"trustLayer\":true"); });
        row(
            "sounds", [](LayoutWindow &one) { one.window->findChild<QCheckBox *>("sounds")->click(); },
            [](const QString &file) { return value(file, "sounds") == "off"; });
        row(
            "name of a button", [](LayoutWindow &one) { name(one, "Back"); },
            [](const QString &file) { return buttonOf(file) == "Back"; });
        row(
            "plots",
            [](LayoutWindow &one) { one.window->findChild<PlotsPanel *>()->board().time().setSpan(7); },
            [](const QString &file) { return Layouts(file).layout().plots["span_s"] == 7; });
        row(
            "set of plots",
            [](LayoutWindow &one) {
                one.window->findChild<PlotsPanel *>()->sets().save("Wheels", {{"panes", QJsonArray()}});
            },
            [](const QString &file) { return value(file, "plotSets").contains("Wheels"); });
    }

    void eachByItself() {
        FETCH(Set, set, IsKept, isKept);
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QTRY_VERIFY(!Layouts(file_).layout().state.isEmpty()); // how it began
        QVERIFY(!isKept(file_));
        set(one);
        QTRY_VERIFY(isKept(file_)); // while it is open
        QCOMPARE(one.notice(), QString());
    }

    void arrangement_data() {
        const Rows<Set> row("set");
        row("a panel closed", [](LayoutWindow &one) { one.dock("drive")->close(); });
        row("a panel in front", [](LayoutWindow &one) { one.dock("events")->raise(); });
        row("a panel apart",
            Set([](LayoutWindow &one) { one.window->findChild<QDockWidget *>("log")->setFloating(true); }));
        row("a panel wider", [](LayoutWindow &one) {
            one.window->resizeDocks({one.window->findChild<QDockWidget *>("daemons")}, {420}, Qt::Horizontal);
        });
        row("the window larger", [](LayoutWindow &one) { one.window->resize(1400, 800); });
        row("all as at first", [](LayoutWindow &one) { one.pick("resetLayout"); });
    }

    void arrangement() {
        QFETCH(Set, set);
        LayoutWindow one(file_, {"127.0.0.1:1"});
        const auto now = [&one] { return qMakePair(one.window->saveState(), one.window->saveGeometry()); };
        const auto isKept = [&] {
            const Layouts::Layout kept = Layouts(file_).layout();
            return qMakePair(kept.state, kept.geometry) == now();
        };
        one.dock("recordings")->hide();
        QTRY_VERIFY(isKept());
        const auto before = now();
        set(one);
        QTRY_VERIFY(now() != before && isKept());
    }

    void whatDoesNotChangeIsNotWritten() {
        LayoutWindow one(file_, {"127.0.0.1:1"});
        const auto inode = [this] {
            struct stat told {};
            return ::stat(QFile::encodeName(file_), &told) == 0 ? told.st_ino : 0;
        };
        const auto begun = inode();
        QTRY_VERIFY(inode() != begun);
        QTest::qWait(1500); // until the window manager has placed it
        const auto settled = inode();
        QTest::qWait(2000);
        QCOMPARE(inode(), settled); // each time it is written it is another file
        one.window->findChild<QAction *>("gridLayer")->trigger();
        QTRY_VERIFY(inode() != settled);
    }

    void whatIsTooMuchIsTold() {
        Layouts layouts(file_);
        const QString before = layouts.value("buttons");
        layouts.setValue("buttons", QString(3 << 19, 'x'));
        const auto saved = layouts.save();
        QVERIFY(!saved);
        VERIFY_CONTAINS(saved.error().message, "it has 1.5 MiB, and may have 1.0 MiB");
        QCOMPARE(Layouts(file_).value("buttons"), before);
    }

private:
    static constexpr const char *ofChild = "HERMES_TEST_KEPT";

    /// By hand, as far as a hand would do it otherwise.
    static void setAll(LayoutWindow &one) {
        const auto action = [&one](const char *name) { return one.window->findChild<QAction *>(name); };
        QTRY_VERIFY(one.fleet.robot() && one.fleet.robot()->withMethod("process.list"));
        one.fleet.rename(*one.fleet.robot(), "Blue");
        one.saveAs("Field");
        one.window->resize(1180, 690);
        one.dock("drive")->hide();
        one.window->findChild<PlotsPanel *>()->setState(
            {{"panes", QJsonArray{QJsonArray{
                           QJsonObject{{"daemon", "127.0.0.1:1"}, {"topic", "a"}, {"field", "b"}}}}}});
        one.window->findChild<PlotsPanel *>()->sets().save("Wheels", {{"panes", QJsonArray()}});
        action("gridLayer")->trigger();
        action("escapeStops")->trigger();
        name(one, "Go home");
        one.dock("events")->raise();
        auto *const sounds = one.window->findChild<EventsPanel *>()->findChild<QCheckBox *>("sounds");
        QTRY_VERIFY(sounds->isVisible());
        QTest::mouseClick(sounds, Qt::LeftButton, {}, {8, sounds->height() / 2});
        QVERIFY(!sounds->isChecked());
    }

    static void name(LayoutWindow &one, const QString &button) {
        OpenWindow::click(one.window.get(), "editButtons");
        OpenWindow::type(one.window->findChild<QLineEdit *>("buttonName"), button);
    }
    static QString value(const QString &file, const QString &key) { return Layouts(file).value(key); }
    static QString buttonOf(const QString &file) {
        return QJsonDocument::fromJson(value(file, "buttons").toUtf8()).array().at(0)["name"].toString();
    }
    static bool isInFront(const LayoutWindow &one, const char *dock) {
        return !one.dock(dock)->visibleRegion().isEmpty();
    }
    static Mischief rover() {
        Mischief supervisor;
        supervisor.topics["processes"] = R"({"robot":"rover","processes":[]})";
        return supervisor;
    }

    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
};
