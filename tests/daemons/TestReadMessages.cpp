// What the scan matcher reads of other daemons' messages.
#include "daemons/scanmatcher/MatcherMessages.h"

using namespace hermes;
using namespace hermes::scanmatcher;

static constexpr double start = 1.7e9;

static QJsonObject message() {
    return {{"pose", QJsonObject{{"x", 1}, {"y", 2}, {"theta", 3}}},
            {"twist", QJsonObject{{"vx", 0.1}, {"vy", 0.2}, {"omega", 0.3}}},
            {"covariance", QJsonArray{1, 0, 0, 0, 2, 0, 0, 0, 3}}};
}

static Result<vectorlib::OdometrySample> odometryOf(const QJsonObject &data, double stamp) {
    quint64 unknown = 0;
    return readOdometry(WireValue(data), stamp, unknown);
}

static Result<Scan> scanOf(const QJsonObject &data) {
    quint64 unknown = 0;
    return readScan(WireValue(data), unknown);
}

static QJsonObject scanMessage() {
    return {{"stamp", start}, {"turn", 7}, {"x", QJsonArray{1, 2}}, {"y", QJsonArray{3, 4}}};
}

class TestReadMessages : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void readsOdometry() {
        const auto sample = odometryOf(message(), start);
        QVERIFY(sample.ok());
        QCOMPARE(sample->stamp, start);
        QCOMPARE(sample->pose.theta, 3.0);
        QCOMPARE(sample->twist.omega, 0.3);
        QCOMPARE((*sample->covariance)(1, 1), 2.0);
    }

    void refusesOdometry_data() {
        const Rows<QString, QJsonValue, QString> row("member", "value", "error");
        const QJsonValue none(QJsonValue::Null);
        row("no pose", "pose", none, "member pose: found null, expected an object");
        row("pose of text", "pose", QJsonValue(QJsonObject{{"x", "1"}}), "member pose.x");
        row("no heading", "pose", QJsonValue(QJsonObject{{"x", 1}, {"y", 1}, {"theta", none}}),
            "member pose.theta: found null, expected a number");
        row("far beyond", "pose", QJsonValue(QJsonObject{{"x", 1e300}, {"y", 1}, {"theta", 1}}),
            "found 1e+300, expected a number from -1e+10 to 1e+10");
        row("no twist", "twist", none, "member twist: found null");
        row("no covariance", "covariance", none, "found null, expected an array of 9");
        row("negative variance", "covariance", QJsonValue(QJsonArray{1, 0, 0, 0, 1, 0, 0, 0, -1}),
            "member covariance.8: found -1, expected a variance");
        row("too fast", "twist", QJsonValue(QJsonObject{{"vx", 125}, {"vy", 0}, {"omega", 0}}),
            "member twist: found 125 m/s, 0 m/s and 0 rad/s, expected what a robot can");
    }

    void refusesOdometry() {
        FETCH(QString, member, QJsonValue, value, QString, error);
        QJsonObject data = message();
        data[member] = value;
        const auto sample = odometryOf(data, start);
        QVERIFY(!sample.ok());
        VERIFY_CONTAINS(sample.error().message, error);
        for (const double stamp : {std::nan(""), -1.0, 1e300})
            QVERIFY(!odometryOf(message(), stamp).ok());
    }

    void readsScans_data() {
        const Rows<QJsonObject, QString> row("data", "error");
        const QJsonArray one{1.0}, two{1.0, 2.0};
        row("good", {{"stamp", 1}, {"x", two}, {"y", two}, {"t", two}}, "");
        row("no points", {{"stamp", 1}, {"x", QJsonArray()}, {"y", QJsonArray()}}, "");
        row("no stamp", {{"x", two}, {"y", two}}, "stamp");
        row("no x", {{"stamp", 1}, {"y", two}}, "member x: found nothing");
        row("fewer y", {{"stamp", 1}, {"x", two}, {"y", one}}, "member y: found an array of 1, expected 2");
        row("null in x", {{"stamp", 1}, {"x", QJsonArray{1, QJsonValue::Null}}, {"y", two}},
            "member x.1: found null, expected a number");
        row("too large", {{"stamp", 1}, {"x", QJsonArray{1, 1e300}}, {"y", two}},
            "member x.1: found 1e+300, expected a number");
        row("stamp in milliseconds", {{"stamp", 1.7e12}, {"x", two}, {"y", two}},
            "expected a number from -1e+10 to 1e+10, in seconds since the Unix epoch, not in milliseconds");
        row("t in milliseconds", {{"stamp", 1}, {"x", two}, {"y", two}, {"t", QJsonArray{0, 97}}},
            "member t.1: found 97, expected seconds after the stamp, of 5 at most; are these milliseconds?");
        row("t of another size", {{"stamp", 1}, {"x", two}, {"y", two}, {"t", one}}, "member t");
    }

    void readsScans() {
        FETCH(QJsonObject, data, QString, error);
        const auto scan = scanOf(data);
        QCOMPARE(scan.ok(), error.isEmpty());
        if (!scan)
            VERIFY_CONTAINS(scan.error().message, error);
    }

    void readsRays() {
        QJsonObject data = scanMessage();
        QCOMPARE(scanOf(data)->data.rays, size_t(2)); // a logger that does not tell: one for each point
        data["rays"] = 1800;
        QCOMPARE(scanOf(data)->data.rays, size_t(1800));
        for (const QJsonValue &rays : {QJsonValue(-1), QJsonValue(1e9), QJsonValue("many"), QJsonValue()}) {
            data["rays"] = rays;
            QVERIFY(!scanOf(data).ok());
            QVERIFY(scanOf(data).error().message.contains("member rays"));
        }
    }

    void countsWhatItDoesNotKnow() {
        QJsonObject data = scanMessage();
        data["colour"] = "red";
        data["shape"] = QJsonArray{1, 2};
        quint64 unknown = 0;
        QVERIFY(readScan(WireValue(data), unknown).ok());
        QCOMPARE(unknown, quint64(2));
        data = message();
        data["twist"] = QJsonObject{{"vx", 0}, {"vy", 0}, {"omega", 0}, {"vz", 0}};
        QVERIFY(readOdometry(WireValue(data), start, unknown).ok());
        QCOMPARE(unknown, quint64(3));
    }
};
