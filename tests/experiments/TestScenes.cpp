#include "vectorlib/experiments/VectorizationExperiment.h"

using namespace hermes;
using namespace hermes::experiments;

/// What the experiments of thesis figures 6.8 to 6.10 show, for N up to 20,000. Long.
class TestScenes : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        ExperimentOptions options;
        options.runs = 10;
        for (const Scene &scene : {solitaryEdges(), sharpCorners(), furnishedRoom()})
            for (const ResultRow &row : sceneExperiment(scene, options))
                results_[scene.name][row.algorithm].push_back(row);
    }
    void rightNumberOfLines_data() { scenes(); }

    void rightNumberOfLines() {
        QFETCH(QString, scene);
        for (const char *algorithm : {"FTLS", "AFTLS", "INC"})
            for (const ResultRow &row : results_[scene.toStdString()][algorithm])
                if (row.points >= 1000)
                    QVERIFY2(std::abs(row.percent(row.lines.mean)) <= 1,
                             saying("%1, %2 points: %3 lines", algorithm, row.points, row.lines.mean));
    }

    void errorAreaKeepsFalling_data() { scenes(); }

    void errorAreaKeepsFalling() {
        QFETCH(QString, scene);
        const std::vector<ResultRow> &aftls = results_[scene.toStdString()]["AFTLS"];
        const std::vector<ResultRow> &ftls = results_[scene.toStdString()]["FTLS"];
        for (std::size_t i = 1; i < aftls.size(); ++i)
            QVERIFY2(aftls[i].area.mean < aftls[i - 1].area.mean,
                     saying("%1 points: %2 m^2, then %3", aftls[i].points, aftls[i - 1].area.mean,
                            aftls[i].area.mean));
        QVERIFY(aftls.back().area.mean <= ftls.back().area.mean);
    }

private:
    void scenes() const {
        const Rows<QString> row("scene");
        for (const auto &scene : results_)
            row(scene.first.c_str(), QString::fromStdString(scene.first));
    }
    std::map<std::string, std::map<std::string, std::vector<ResultRow>>> results_; // by scene and algorithm
};
