// What the scan matcher reads of other daemons' messages.
#include "daemons/scanmatcher/ReadMessages.h"

#include <QJsonArray>
#include <QtTest>

#include <cmath>

using namespace hermes;

namespace {

constexpr double start = 1.7e9;

QJsonObject message() {
    return {{"pose", QJsonObject{{"x", 1}, {"y", 2}, {"theta", 3}}},
            {"twist", QJsonObject{{"vx", 0.1}, {"vy", 0.2}, {"omega", 0.3}}},
            {"covariance", QJsonArray{1, 0, 0, 0, 2, 0, 0, 0, 3}}};
}

QJsonObject scanMessage() {
    return {{"stamp", start}, {"turn", 7}, {"x", QJsonArray{1, 2}}, {"y", QJsonArray{3, 4}}};
}

} // namespace

class TestReadMessages : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void readsOdometry();
    void refusesOdometry_data();
    void refusesOdometry();
    void readsScans_data();
    void readsScans();
    void readsRays();
};

void TestReadMessages::readsOdometry() {
    const auto sample = readOdometry(message(), start);
    QVERIFY(sample.ok());
    QCOMPARE(sample->stamp, start);
    QCOMPARE(sample->pose.theta, 3.0);
    QCOMPARE(sample->twist.omega, 0.3);
    QCOMPARE((*sample->covariance)(1, 1), 2.0);
}

void TestReadMessages::refusesOdometry_data() {
    QTest::addColumn<QString>("member");
    QTest::addColumn<QJsonValue>("value");
    QTest::addColumn<QString>("error");
    const QJsonValue none(QJsonValue::Null);
    QTest::newRow("no pose") << "pose" << none << "member pose.x: found no number";
    QTest::newRow("pose of text") << "pose" << QJsonValue(QJsonObject{{"x", "1"}}) << "member pose.x";
    QTest::newRow("no heading") << "pose" << QJsonValue(QJsonObject{{"x", 1}, {"y", 1}, {"theta", none}})
                                << "member pose.theta: found no number";
    QTest::newRow("far beyond") << "pose" << QJsonValue(QJsonObject{{"x", 1e300}, {"y", 1}, {"theta", 1}})
                                << "found 1e+300, expected a number from -1e+10 to 1e+10";
    QTest::newRow("no twist") << "twist" << none << "member twist.vx";
    QTest::newRow("no covariance") << "covariance" << none << "found 0 numbers, expected 9";
    QTest::newRow("negative variance") << "covariance" << QJsonValue(QJsonArray{1, 0, 0, 0, 1, 0, 0, 0, -1})
                                       << "member covariance[8]: found -1, expected a number from 0";
}

void TestReadMessages::refusesOdometry() {
    QFETCH(QString, member);
    QFETCH(QJsonValue, value);
    QFETCH(QString, error);
    QJsonObject data = message();
    data[member] = value;
    const auto sample = readOdometry(data, start);
    QVERIFY(!sample.ok());
    QVERIFY2(sample.error().message.contains(error), qPrintable(sample.error().message));
    for (const double stamp : {std::nan(""), -1.0, 1e300})
        QVERIFY(!readOdometry(message(), stamp).ok());
}

void TestReadMessages::readsScans_data() {
    QTest::addColumn<QJsonObject>("data");
    QTest::addColumn<QString>("error");
    const QJsonArray one{1.0}, two{1.0, 2.0};
    QTest::newRow("good") << QJsonObject{{"stamp", 1}, {"x", two}, {"y", two}, {"t", two}} << "";
    QTest::newRow("no points") << QJsonObject{{"stamp", 1}, {"x", QJsonArray()}, {"y", QJsonArray()}} << "";
    QTest::newRow("no stamp") << QJsonObject{{"x", two}, {"y", two}} << "stamp";
    QTest::newRow("no x") << QJsonObject{{"stamp", 1}, {"y", two}} << "member x: found nothing";
    QTest::newRow("fewer y") << QJsonObject{{"stamp", 1}, {"x", two}, {"y", one}}
                             << "found 1 numbers, expected 2";
    QTest::newRow("null in x") << QJsonObject{{"stamp", 1},
                                              {"x", QJsonArray{1, QJsonValue::Null}},
                                              {"y", two}}
                               << "element 1";
    QTest::newRow("too large") << QJsonObject{{"stamp", 1}, {"x", QJsonArray{1, 1e300}}, {"y", two}}
                               << "element 1";
    QTest::newRow("t of another size")
        << QJsonObject{{"stamp", 1}, {"x", two}, {"y", two}, {"t", one}} << "member t";
}

void TestReadMessages::readsScans() {
    QFETCH(QJsonObject, data);
    QFETCH(QString, error);
    const auto scan = readScan(data);
    QCOMPARE(scan.ok(), error.isEmpty());
    if (!scan)
        QVERIFY2(scan.error().message.contains(error), qPrintable(scan.error().message));
}

void TestReadMessages::readsRays() {
    QJsonObject data = scanMessage();
    QCOMPARE(readScan(data)->data.rays, size_t(2)); // a logger that does not tell: one for each point
    data["rays"] = 1800;
    QCOMPARE(readScan(data)->data.rays, size_t(1800));
    for (const QJsonValue &rays : {QJsonValue(-1), QJsonValue(1e9), QJsonValue("many"), QJsonValue()}) {
        data["rays"] = rays;
        QVERIFY(!readScan(data).ok());
        QVERIFY(readScan(data).error().message.contains("member rays"));
    }
}

QTEST_GUILESS_MAIN(TestReadMessages)
#include "TestReadMessages.moc"
