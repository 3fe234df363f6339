#include "gui/desktop/model/Macro.h"
#include "tests/gui/desktop/LayoutWindow.h"

using namespace hermes;

static std::atomic<int> syncs{0};
static std::atomic<bool> isSlow{false}; // whoever writes waits until it is not, for two seconds at most

static int syncSlowly() {
    ++syncs;
    for (int i = 0; i < 400 && isSlow; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return 0;
}

// In the place of those of the C library.
extern "C" int fsync(int) {
    return syncSlowly();
}
extern "C" int fdatasync(int) {
    return syncSlowly();
}

/// How long the event loop stood at most.
class Standing {
public:
    Standing() {
        beat_.setTimerType(Qt::PreciseTimer);
        QObject::connect(&beat_, &QTimer::timeout, &beat_,
                         [this] { most_ms_ = qMax(most_ms_, last_.restart()); });
        last_.start();
        beat_.start(5);
    }
    qint64 most_ms() {
        QTest::qWait(20); // what it stood last
        return most_ms_;
    }

private:
    QTimer beat_;
    QElapsedTimer last_;
    qint64 most_ms_ = 0;
};

using Set = std::function<void(LayoutWindow &)>;
Q_DECLARE_METATYPE(Set)

/// A disk on which whatever is written takes up to two seconds holds up no STOP.
class TestSlowDisk : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("gui.json");
    }

    void cleanup() { isSlow = false; }

    void whatIsSet_data() {
        const Rows<Set> row("set");
        row("layout", [](LayoutWindow &one) { one.saveAs("Bench"); });
        row("layer",
            Set([](LayoutWindow &one) { one.window->findChild<QAction *>("trustLayer")->trigger(); }));
        row("robot added", [](LayoutWindow &one) { one.fleet.add("127.0.0.1:2"); });
        row("robot renamed",
            Set([](LayoutWindow &one) { one.fleet.rename(*one.fleet.robots().front(), "Blue"); }));
        row("robot chosen", [](LayoutWindow &one) {
            one.fleet.add("127.0.0.1:2");
            one.fleet.choose(one.fleet.robots().back().get());
        });
        row("plots",
            Set([](LayoutWindow &one) { one.window->findChild<PlotsPanel *>()->board().time().setSpan(7); }));
    }

    void whatIsSet() {
        QFETCH(Set, set);
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QTRY_VERIFY(!Layouts(file_).layout().state.isEmpty()); // how it began
        QTest::qWait(1000);
        isSlow = true;
        const int before = syncs;
        Standing standing;
        set(one);
        QTRY_VERIFY(syncs > before);
        QTest::qWait(300); // in the middle of it
        isSlow = false;
        QVERIFY2(standing.most_ms() < limit_ms, saying(standing.most_ms()));
    }

    void exports_data() {
        const Rows<QString, QString> row("action", "name");
        row("map as SVG", "export", "map.svg");
        row("map as PNG", "export", "map.png");
        row("plots as SVG", "picture", "plots.svg");
        row("plots as PNG", "picture", "plots.png");
        row("plots as CSV", "csv", "plots.csv");
    }

    void exports() {
        FETCH(QString, action, QString, name);
        LayoutWindow one({}, {"127.0.0.1:1"});
        one.window->findChild<QAction *>(action)->trigger();
        auto *const dialog = one.window->findChild<QFileDialog *>();
        QVERIFY(dialog && !dialog->isModal());
        QTest::qWait(500);
        isSlow = true;
        const int before = syncs;
        const QString path = folder_->filePath(name);
        Standing standing;
        Q_EMIT dialog->fileSelected(path);
        QTRY_VERIFY(syncs > before);
        QTest::qWait(300);
        isSlow = false;
        QTRY_VERIFY_WITH_TIMEOUT(QFileInfo(path).size() > 0, 20000);
        QVERIFY2(standing.most_ms() < limit_ms, saying(standing.most_ms()));
    }

    void closing() {
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QTRY_VERIFY(!Layouts(file_).layout().state.isEmpty());
        QTest::qWait(1000);
        isSlow = true;
        Standing standing;
        one.window->findChild<QAction *>("trustLayer")->trigger();
        one.window->close();
        QVERIFY(one.window->isVisible() && one.isWhole()); // STOP is in reach
        VERIFY_CONTAINS(one.notice(), "still being written");
        isSlow = false;
        QTRY_VERIFY_WITH_TIMEOUT(!one.window->isVisible(), 20000); // by itself
        QVERIFY2(standing.most_ms() < limit_ms, saying(standing.most_ms()));
        QVERIFY(Layouts(file_).value("layers").contains("\"trustLayer\":true"));
    }

    void closingAgainWaitsForNothing() {
        {
            LayoutWindow one(file_, {"127.0.0.1:1"});
            QTRY_VERIFY(!Layouts(file_).layout().state.isEmpty());
            QTest::qWait(1000);
            isSlow = true;
            one.window->findChild<QAction *>("trustLayer")->trigger();
            one.window->close();
            QVERIFY(one.window->isVisible());
            one.window->close();
            QVERIFY(!one.window->isVisible());
        }
        QVERIFY(Layouts(file_).value("layers").contains("\"trustLayer\":true")); // the end waited
    }

private:
    static constexpr qint64 limit_ms = 700; // with other tests beside; the disk takes three times as much

    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
};
