#include "protocol/nmea/Rmc.h"

using namespace hermes::nmea;

class TestNmeaDates : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void stampsOfDates_data() {
        const Rows<int, int, int> row("year", "month", "day");
        for (const int year : {1970, 1972, 1999, 2000, 2001, 2024, 2026, 2079, 2100, 2400, 9999}) {
            for (const auto &[month, day] : {std::pair(1, 1), {2, 28}, {3, 1}, {12, 31}})
                QTest::addRow("%d-%d-%d", year, month, day) << year << month << day;
        }
        row("leap day", 2000, 2, 29);
    }

    void stampsOfDates() {
        FETCH(int, year, int, month, int, day);
        const double expected =
            double(QDateTime(QDate(year, month, day), QTime(1, 2, 3), Qt::UTC).toSecsSinceEpoch());
        const double stamp = toStamp({year, month, day}, {1, 2, 3.5}).value();
        QCOMPARE(stamp, expected + 0.5);
        const Date date = dateOf(stamp).value();
        QCOMPARE(date.year, year);
        QCOMPARE(date.month, month);
        QCOMPARE(date.day, day);
    }

    void stampsAndDatesAreInverse() {
        for (double stamp = 0.25; stamp < 4e9; stamp += 86399.5 * 7)
            QCOMPARE(toStamp(dateOf(stamp).value(), timeOf(stamp).value()).value(), stamp);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        for (const double wrong : {-1.0, nan, 1e300, 253402300800.0})
            QVERIFY(!dateOf(wrong) && !timeOf(wrong));
        QVERIFY(!toStamp({2015, 2, 29}, {0, 0, 0}) && !toStamp({2015, 2, 28}, {0, 0, nan}));
    }

    void aRolledOverCountOfWeeksIsSeen() {
        constexpr double now = 1795400000, weeks = 1024 * 7 * 86400;
        for (const double off_s : {0.0, 3600.0, -80000.0}) {
            QVERIFY(isRolledOver(now - weeks + off_s, now) && isRolledOver(now - 2 * weeks + off_s, now));
            QVERIFY(isRolledOver(now + weeks + off_s, now));
            QVERIFY(!isRolledOver(now + off_s, now) && !isRolledOver(now - weeks / 2 + off_s, now));
        }
    }
};
