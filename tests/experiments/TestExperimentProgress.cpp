#include "gui/vector/MapRun.h"
#include "gui/vector/Options.h"
#include "gui/vector/ProgressParts.h"
#include "tests/experiments/ExperimentFiles.h"
#include "tests/gui/VectorProgram.h"
#include "tests/support/Latex.h"
#include "vectorlib/experiments/Commands.h"
#include "vectorlib/experiments/ExperimentCommand.h"

#include <vectorlib/mapping/MapAligner.h>
#include <vectorlib/observation/FloorPlan.h>

#include <iostream>

using namespace hermes::experiments;
using namespace hermes::vector;

/// Every experiment, and whatever else takes long, tells how far it is, up to its end, and leaves a whole
/// document where it draws. Experiments that are done at once, and those that draw nothing, are listed here.
class TestExperimentProgress : public QObject {
    Q_OBJECT

    QTemporaryDir folder_;
    const QStringList short_{"segmentation-room", "segmentation-objects", "adaptive-threshold", "threshold",
                             "real-segmentation", "empty-room",           "corridor",           "laboratory",
                             "criterion",         "registration-space",   "free-copy"};
    const QStringList undrawn_{"pairs", "places", "drawn-places", "place-trust", "pose-trust"};

    static QStringList names() {
        CLI::App app;
        addExperimentCommand(app);
        const std::string help = app.get_subcommand("experiment")->help();
        return QRegularExpression("NAME TEXT:\\{([a-z,-]+)\\}")
            .match(QString::fromStdString(help))
            .captured(1)
            .split(',', Qt::SkipEmptyParts);
    }
    /// What a sink is told.
    struct Told {
        std::size_t last = 0, total = 0, calls = 0;
        bool isSteady = true; ///< never back, and always of the same total

        ProgressSink sink() {
            return [this](std::size_t done, std::size_t all) {
                isSteady = isSteady && done >= last && done <= all && (calls == 0 || all == total);
                last = done;
                total = all;
                ++calls;
            };
        }
    };
    static std::vector<vectorlib::MapEdge> mapOf(const std::vector<vectorlib::LineSegment2D<double>> &walls) {
        std::vector<vectorlib::MapEdge> map;
        for (const auto &wall : walls)
            map.emplace_back(std::int64_t(map.size()), vectorlib::EdgeRaw2D({}, wall, 0), 4);
        return map;
    }
    ExperimentCommand quickly(const QString &name) {
        const std::string log = data("corrected.log").toStdString();
        ExperimentCommand command;
        command.name = name.toStdString();
        command.folder = folder_.filePath(name).toStdString();
        command.worlds = qEnvironmentVariable("HERMES_SOURCE").toStdString() + "/deploy/worlds";
        command.runs = 2;
        command.options.maxPoints = 500;
        command.logs = {log};
        if (name == "place-trust" || name == "pose-trust" || name == "places")
            command.others = {log};
        if (name == "baseline") // its worlds have more scans
            command.logs.clear();
        if (name == "free-approach")
            command.every = {100};
        return command;
    }

private Q_SLOTS:
    void initTestCase() { QVERIFY(folder_.isValid()); }

    void partsAreToldAsOne() {
        std::vector<std::pair<std::size_t, std::size_t>> told;
        ProgressParts parts([&told](std::size_t done, std::size_t all) { told.emplace_back(done, all); },
                            {10, 0, 90});
        const ProgressSink first = parts.next(), empty = parts.next(), last = parts.next();
        first(1, 2);
        first(2, 2);
        empty(1, 1);
        last(0, 0); // nothing to do: nothing is told
        last(1, 3);
        last(3, 3);
        const std::vector<std::pair<std::size_t, std::size_t>> wanted{
            {5, 100}, {10, 100}, {10, 100}, {40, 100}, {100, 100}};
        QCOMPARE(told, wanted);
    }

    void isToldToTheEnd_data() {
        const Rows<bool> row("isShort");
        QVERIFY(names().size() > 35);
        for (const QString &name : names())
            row(qPrintable(name), short_.contains(name));
    }
    void isToldToTheEnd() {
        QFETCH(bool, isShort);
        ExperimentCommand command = quickly(QTest::currentDataTag());
        Told told;
        command.options.progress = told.sink();
        std::ostringstream aside;
        const std::unique_ptr<std::streambuf, void (*)(std::streambuf *)> shown(
            std::cout.rdbuf(aside.rdbuf()), [](std::streambuf *usual) { std::cout.rdbuf(usual); });
        command.run();
        QVERIFY(told.isSteady);
        QCOMPARE(told.last, told.total);
        QVERIFY2(isShort || told.calls > 1, "to be told, or to be listed as short");

        const QDir left(QString::fromStdString(command.folder));
        const QStringList documents = left.entryList({"*.tex"}), figures = left.entryList({"*-figures.json"});
        QCOMPARE(documents.isEmpty(), undrawn_.contains(QTest::currentDataTag()));
        if (hasMatplotlib())
            for (const QString &file : figures)
                QCOMPARE(QProcess::execute(qEnvironmentVariable("HERMES_SOURCE") +
                                               "/vectorlib/experiments/plot.py",
                                           {left.filePath(file)}),
                         0);
        static const hermes::Latex latex;
        for (const QString &name : documents) {
            const QList<QByteArray> text = lines(left.filePath(name));
            QVERIFY(text.first().startsWith("\\documentclass") && text.last() == "\\end{document}");
            QVERIFY(text.join().contains("tikzpicture") || text.join().contains("\\includegraphics"));
            const QByteArray fault =
                latex.missing().isEmpty() ? hermes::Latex::fault(left.filePath(name)) : QByteArray();
            QVERIFY2(fault.isEmpty(), fault.constData());
        }
    }

    void mapIsToldToItsEnd() {
        MapRun run;
        MapSourceOptions source;
        source.path = data("corrected.log").toStdString();
        source.corrected = true;
        readMapScans(source, [&run](MapScan &scan, std::size_t, std::size_t) { run.take(scan); });
        Told told;
        QStringList stages;
        run.finish([&stages](const char *stage) { stages.append(stage); }, told.sink());
        QCOMPARE(stages.first(), QString("closing loops"));
        QCOMPARE(stages.last(), QString("reviewing the walls"));
        QVERIFY(told.isSteady && told.total > 0);
        QCOMPARE(told.last, told.total);
    }
    void alignmentCountsPlaces() {
        const std::vector<vectorlib::MapEdge> walls = mapOf(vectorlib::FloorPlan(1, 8).walls());
        vectorlib::VectorMap map;
        for (const vectorlib::MapEdge &wall : walls)
            map.add(wall, wall.observations);
        Told told;
        vectorlib::MapAligner align;
        align.progress = told.sink();
        const vectorlib::MapAlignment found = align(map, walls);
        QVERIFY(told.isSteady && found.places > 0);
        QCOMPARE(told.calls, found.places);
        QCOMPARE(told.last, told.total);
    }
    void searchCountsSteps() {
        const std::vector<vectorlib::MapEdge> map = mapOf(vectorlib::FloorPlan(1, 20).walls());
        const std::vector<vectorlib::EdgeRaw2D> seen(map.begin(), map.begin() + 10);
        Told told;
        vectorlib::PlaceSearch search;
        search.progress = told.sink();
        search(map, seen, {});
        QVERIFY(told.isSteady && told.calls > 10);
    }
};
