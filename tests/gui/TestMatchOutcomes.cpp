#include "tests/gui/VectorProgram.h"

/// How hermes-vector match ends, in the same keys and words whatever the method.
class TestMatchOutcomes : public QObject, protected TestFolder {
    Q_OBJECT

private Q_SLOTS:
    void init() { empty(); }

    void keysAreTheSameForAllMethods() {
        const QString a = seen("a.csv", "0,0,0", true), b = seen("b.csv", "0.2,0.1,0.1", true);
        QStringList known, knownOfSolution;
        for (const QStringList &method : {QStringList{"--method", "global"},
                                          {"--method", "finder"},
                                          {"--method", "relations"},
                                          {"--expected", "0.2,0.1,0.1"}}) {
            const QJsonObject result = json(run(QStringList{"match", a, b} + method).out);
            const QStringList keys = result.keys(),
                              ofSolution = result["solutions"].toArray()[0].toObject().keys();
            QVERIFY(known.isEmpty() || keys == known);
            QVERIFY(knownOfSolution.isEmpty() || ofSolution == knownOfSolution);
            known = keys;
            knownOfSolution = ofSolution;
        }
        QVERIFY(known.contains("text") && knownOfSolution.contains("score"));
    }

    void outcomeIsTheSameForAllMethods_data() {
        const Rows<QStringList> row("options");
        row("global", {"--method", "global"});
        row("finder", {"--method", "finder", "--expected", "0,0,1.57", "--max-dalpha",
                       "1.6"}); // half a turn is permitted
        row("relations", {"--method", "relations"});
    }

    void outcomeIsTheSameForAllMethods() {
        QFETCH(QStringList, options);
        put(path("rectangle"), "-3,-2,3,-2\n3,-2,3,2\n3,2,-3,2\n-3,2,-3,-2\n");
        put(path("corridor"), "-3,-1,3,-1\n3,1,-3,1\n");
        put(path("corner"), "1,-1,1,1\n1,1,-3,1\n");
        put(path("crumbs"), "2,-0.2,2,0.2\n0.2,2,-0.3,1.8\n");
        put(path("dots"), "1,1,1,1\n2,2,2,2\n"); // segments of no length
        const struct {
            const char *fixed, *moving, *outcome;
        } cases[] = {{"rectangle", "rectangle", "ambiguous"},
                     {"corridor", "corridor", "open_direction"},
                     {"crumbs", "corner", "nowhere"},
                     {"dots", "corner", "too_little"},
                     {"corner", "dots", "too_little"}};
        for (const auto &c : cases) {
            const QJsonObject r =
                json(run(QStringList{"match", path(c.fixed), path(c.moving)} + options).out);
            const QString told = r["outcome"].toString(), text = r["text"].toString();
            QVERIFY2(told == c.outcome, qPrintable(QString(c.fixed) + ": " + text));
            // The text begins with the same words, and says more, of the sets by the names that the command
            // has.
            VERIFY_STARTS(text, QString(told).replace('_', ' ') + ": ");
            if (told == "too_little")
                VERIFY_CONTAINS(text, c.fixed == QByteArray("dots") ? "static" : "dynamic");
        }
    }

    void tellsWhyNothingIsAccepted() {
        const QString a = seen("a.csv", "0,0,0", true), b = seen("b.csv", "0.2,0.1,0.1", true);
        const Result strict = ran({"match", a, b, "--ambiguity", "0.00000001"});
        for (const QJsonValue &s : json(strict.out)["solutions"].toArray()) {
            QVERIFY(!s.toObject()["accepted"].toBool());
            QVERIFY(s.toObject()["verdict"].toString() != QLatin1String("accepted"));
        }
        put(path("wall.csv"), "1,-2,1,2\n");
        const Result corridor = ran({"match", path("wall.csv"), path("wall.csv"), "--method", "finder"});
        QVERIFY(json(corridor.out)["solutions"].toArray().isEmpty());
        QCOMPARE(json(corridor.out)["outcome"].toString(), QString("open_direction"));
        QVERIFY(json(corridor.out)["text"].toString().contains("parallel"));
        QVERIFY2(corridor.err.contains("parallel"), corridor.err.constData());
        put(path("dots.csv"), "1,1,1,1\n2,2,2,2\n"); // segments of no length
        const QJsonObject dots = json(run({"match", path("dots.csv"), b}).out);
        QCOMPARE(dots["outcome"].toString(), QString("too_little"));
        QVERIFY(dots["text"].toString().contains("static set"));
    }

    // A rectangle looks the same from two places; a single wall slides along itself.
    void ambiguityIsTold() {
        put(path("rectangle.csv"), "-3,-2,3,-2\n3,-2,3,2\n3,2,-3,2\n-3,2,-3,-2\n");
        const QJsonObject two = json(run({"match", path("rectangle.csv"), path("rectangle.csv")}).out);
        QCOMPARE(two["outcome"].toString(), QString("ambiguous"));
        const QJsonArray solutions = two["solutions"].toArray();
        QVERIFY(solutions.size() >= 2);
        for (int i = 0; i < 2; ++i) {
            QVERIFY(!solutions[i].toObject()["accepted"].toBool());
            QVERIFY(solutions[i].toObject()["probability"].toDouble() > 0.2);
        }
        put(path("wall.csv"), "1,-2,1,2\n");
        const QJsonObject wall = json(run({"match", path("wall.csv"), path("wall.csv")}).out);
        QVERIFY(!wall["outcome"].toString().isEmpty() && wall["outcome"].toString() != "found");
        for (const QJsonValue &solution : wall["solutions"].toArray())
            QVERIFY(!solution["accepted"].toBool());
    }
};
