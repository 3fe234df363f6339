#include "NmeaText.h"
#include "protocol/nmea/Gga.h"
#include "protocol/nmea/Rmc.h"
#include "protocol/nmea/SentenceParser.h"
#include "tests/support/AllocationCounter.h"

using namespace hermes::nmea;

/// The worked sentences are those of the published field lists; the first RMC comes from a real receiver.
class TestNmeaMessages : public QObject {
    Q_OBJECT

    /// The sentence with its checksum put right.
    static QByteArray summed(const QByteArray &body) {
        const auto sum = checksum({body.constData(), std::size_t(body.size())});
        return '$' + body + '*' + QByteArray::number(sum, 16).rightJustified(2, '0') + "\r\n";
    }

    template <typename Message>
    static FieldFault decodeText(const QByteArray &text, Message &message) {
        SentenceParser parser;
        for (const char byte : text) {
            if (parser.feed(byte) == SentenceParser::Result::Done)
                return decode(parser.sentence(), message);
        }
        return {-1, "a sentence"};
    }

    template <typename Message>
    static QByteArray encoded(const Message &message, const Decimals &decimals = {}) {
        const auto text = encode(message, "GP", decimals);
        return text ? toBytes(text->view()) : QByteArray();
    }

private Q_SLOTS:
    void workedRmcIsReadAndWritten_data() {
        const Rows<QByteArray, int, double, double, double, double, double, double> row(
            "text", "minuteDecimals", "latitude", "longitude", "speed", "course", "variation", "stamp");
        row("real", realRmc, 4, 37 + 7.8178 / 60, -121 - 39.269 / 60, 10.3 * 0.514444, 188.2, 13.8,
            1437687666.0);
        row("south of London", "$GPRMC,220516,A,5133.82,N,00042.24,W,173.8,231.8,130694,004.2,W*70\r\n", 2,
            51 + 33.82 / 60, -42.24 / 60, 173.8 * 0.514444, 231.8, -4.2, 771545116.0);
        row("Munich", "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n", 3,
            48 + 7.038 / 60, 11 + 31.0 / 60, 22.4 * 0.514444, 84.4, -3.1, 764426119.0);
    }

    void workedRmcIsReadAndWritten() {
        FETCH(QByteArray, text, int, minuteDecimals, double, latitude, double, longitude, double, speed,
              double, course, double, variation, double, stamp);
        Rmc rmc;
        const FieldFault fault = decodeText(text, rmc);
        QVERIFY2(!fault, fault.expected);
        QVERIFY(rmc.valid && rmc.position && rmc.speed && rmc.course_deg && rmc.variation_deg);
        QCOMPARE(rmc.position->latitude_deg, latitude);
        QCOMPARE(rmc.position->longitude_deg, longitude);
        QVERIFY(std::abs(*rmc.speed - speed) < 1e-4);
        QCOMPARE(*rmc.course_deg, course);
        QCOMPARE(*rmc.variation_deg, variation);
        QCOMPARE(toStamp(*rmc.date, *rmc.time).value(), stamp);
        QCOMPARE(encoded(rmc, {minuteDecimals, 0}), text);
    }

    void workedGgaIsReadAndWritten() {
        Gga gga;
        const FieldFault fault = decodeText(usualGga, gga);
        QVERIFY2(!fault, fault.expected);
        QCOMPARE(gga.time->hour, 12);
        QCOMPARE(gga.time->minute, 35);
        QCOMPARE(gga.time->second, 19.0);
        QCOMPARE(gga.position->latitude_deg, 48 + 7.038 / 60);
        QCOMPARE(gga.position->longitude_deg, 11 + 31.0 / 60);
        QCOMPARE(gga.quality, 1);
        QCOMPARE(gga.satellites.value(), 8);
        QCOMPARE(gga.hdop.value(), 0.9);
        QCOMPARE(gga.altitude.value(), 545.4);
        QCOMPARE(gga.separation.value(), 46.9);
        QVERIFY(!gga.age_s && !gga.station);
        QCOMPARE(encoded(gga, {3, 0}), usualGga);
        gga.position->longitude_deg = -gga.position->longitude_deg;
        gga.altitude = -12.5;
        gga.age_s = 3.5;
        gga.station = 17;
        gga.time->second = 19.25;
        Gga again;
        QVERIFY(!decodeText(encoded(gga, {7, 2}), again));
        QVERIFY(std::abs(again.position->longitude_deg - gga.position->longitude_deg) < 1e-9);
        QCOMPARE(again.altitude.value(), -12.5);
        QCOMPARE(again.age_s.value(), 3.5);
        QCOMPARE(again.station.value(), 17);
        QCOMPARE(again.time->second, 19.25);
    }

    void emptyFieldsAreUnknown() {
        Rmc rmc;
        QVERIFY(!decodeText(summed("GPRMC,,V,,,,,,,,,,N"), rmc));
        QVERIFY(!rmc.valid && !rmc.time && !rmc.date && !rmc.position && !rmc.speed && !rmc.course_deg);
        QCOMPARE(rmc.mode.value(), 'N');
        QCOMPARE(encoded(rmc), summed("GPRMC,,V,,,,,,,,,,N").toUpper());
        Gga gga;
        QVERIFY(!decodeText(summed("GPGGA,,,,,,0,,,,M,,M,,"), gga));
        QVERIFY(!gga.position && !gga.satellites && !gga.hdop && !gga.altitude);
        QCOMPARE(encoded(gga), summed("GPGGA,,,,,,0,,,,M,,M,,").toUpper());
        // Of an old receiver: no mode, no variation.
        QVERIFY(!decodeText(summed("GPRMC,101112.50,A,4807.,N,01131,E,,,010203"), rmc));
        QCOMPARE(rmc.time->second, 12.5);
        QCOMPARE(rmc.date->year, 2003);
        QVERIFY(rmc.valid && rmc.position && !rmc.speed && !rmc.mode);
        // Without a fix some leave the letters.
        QVERIFY(!decodeText(summed("GPRMC,101112,V,,N,,E,,,010203"), rmc));
        QVERIFY(rmc.time && !rmc.position);
    }

    void wrongFieldsAreNamed_data() {
        const Rows<QByteArray, int> row("body", "field");
        const auto rmc = [&](const char *name, int field, const char *value) {
            QList<QByteArray> fields =
                QByteArray("GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D").split(',');
            fields[field] = value;
            row(name, fields.join(','), field);
        };
        for (const char *time : {"240000", "126000", "120061", "1200000", "12000x", "-10000", "120000.-5",
                                 "120000.5.5", "nan", " 20000"})
            rmc(QByteArray("time ").append(time).constData(), 1, time);
        rmc("status", 2, "X");
        rmc("no status", 2, "");
        for (const char *latitude : {"9000.001", "3760.0", "-707.8", "003707.8", "3707.81e1", "inf", "."})
            rmc(QByteArray("latitude ").append(latitude).constData(), 3, latitude);
        rmc("no latitude", 3, "");
        rmc("longitude", 5, "18000.1");
        row("too few fields", "GPRMC,214106,A", 0);
        row("another type", "GPGGA,,,,,,0,,,,M,,M,,", 0);
    }

    void wrongFieldsAreNamed() {
        FETCH(QByteArray, body, int, field);
        Rmc rmc;
        const FieldFault fault = decode(Sentence({body.constData(), std::size_t(body.size())}), rmc);
        QVERIFY(fault);
        QCOMPARE(fault.field, field);
        QVERIFY(std::string_view(fault.expected).size() > 3);
    }

    /// As receivers send them: no variation is 999.9 or 0.0 without a side.
    void fieldsThatAreNotUsedRefuseNothing_data() {
        rowsOf<QByteArray>("tail", {"999.9,E,A", "999.9,,D", "13.8,,A", ",W,A", "181,E,A", "-1.0,E,A",
                                    "13.8,N,A", "x,E,A", "13.8,E,d", "13.8,E,A,V", "13.8,E,A,", "13.8,E",
                                    "13.8", "", "a,b,c,d,e,f"});
    }

    void fieldsThatAreNotUsedRefuseNothing() {
        QFETCH(QByteArray, tail);
        Rmc rmc;
        const FieldFault fault =
            decodeText(summed("GPRMC,214106.25,A,3707.8178,N,12139.2690,W,010.3,188.2,230715," + tail), rmc);
        QVERIFY2(!fault, fault.expected);
        QVERIFY(rmc.valid && rmc.position && rmc.time->second == 6.25 && rmc.date->day == 23);
        QCOMPARE(*rmc.course_deg, 188.2);
        QCOMPARE(rmc.variation_deg.has_value(), tail.startsWith("13.8,E"));
        QVERIFY(!encoded(rmc).isEmpty());
        for (const char *end : {"M,-,M,,", "M,46.9,M,x,0138", "M,1e3,M,-1,99999", "M,,,,TSTR", ""}) {
            Gga gga;
            const FieldFault ggaFault = decodeText(
                summed(QByteArray("GNGGA,214106,3707.8178,N,12139.2690,W,4,08,0.9,545.4,") + end), gga);
            QVERIFY2(!ggaFault, ggaFault.expected);
            QVERIFY(gga.position && gga.quality == 4 && *gga.altitude == 545.4);
            QVERIFY(!encoded(gga).isEmpty());
        }
    }

    void whatIsOddIsUnknown_data() {
        Rows<int, QByteArray>("field", "value");
        const auto row = [](int field, const char *value) {
            QTest::addRow("field %d: %s", field, value) << field << QByteArray(value);
        };
        for (const char *speed : {"-0.1", "0x10", "1e3", "+-1", "+", "nan", ".", "10000"})
            row(7, speed);
        for (const char *course : {"360.01", "-90", "x"})
            row(8, course);
        for (const char *date : {"000000", "290215", "000715", "011315", "23071", "nan"})
            row(9, date);
    }

    /// The position is as good as before. Without a fix receivers write anything, also in the fields of the
    /// position.
    void whatIsOddIsUnknown() {
        FETCH(int, field, QByteArray, value);
        QByteArrayList fields =
            QByteArray("GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D").split(',');
        fields[field] = value;
        Rmc rmc;
        const FieldFault fault = decodeText(summed(fields.join(',')), rmc);
        QVERIFY2(!fault, fault.expected);
        QVERIFY(rmc.valid && rmc.position && rmc.time);
        QCOMPARE(rmc.speed.has_value(), field != 7);
        QCOMPARE(rmc.course_deg.has_value(), field != 8);
        QCOMPARE(rmc.date.has_value(), field != 9);
        fields[2] = "V";
        fields[3] = value;
        QVERIFY(!decodeText(summed(fields.join(',')), rmc));
        QVERIFY(!rmc.valid);
        Gga gga;
        QVERIFY(!decodeText(summed("GPGGA,214106,3707.8178,N,12139.2690,W,2," + value + ",1,1,M"), gga));
        QVERIFY(gga.position && gga.quality == 2);
        QVERIFY(!decodeText(summed("GPGGA,214106,3707.8178,N,12139.2690,W,2,08,x,+240.3,M"), gga));
        QVERIFY(gga.position && gga.altitude == 240.3 && !gga.hdop);
        QVERIFY(!decodeText(summed("GPGGA,------,3707.8178,N," + value + ",W,0,00,99.9,,M"), gga));
        QCOMPARE(gga.quality, 0);
    }

    void zerosAtTheBeginningMayBeMissing_data() {
        const Rows<QByteArray, double, double> row("position", "latitude", "longitude");
        row("one degree", "4426.291992,N,159.931976,W", 44.4381999, -1.9988663);
        row("two degrees", "407.5,S,1026.6634,E", -4.125, 10.4443900);
        row("no degree", "59.5,N,9.3,E", 0.9916667, 0.155);
        row("nothing but zero", "0,N,0.0,E", 0.0, 0.0);
    }

    void zerosAtTheBeginningMayBeMissing() {
        QFETCH(QByteArray, position);
        Rmc rmc;
        const FieldFault fault = decodeText(summed("GPRMC,92738.00,A," + position + ",0,0,100724"), rmc);
        QVERIFY2(!fault, fault.expected);
        QTEST(std::round(rmc.position->latitude_deg * 1e7) / 1e7, "latitude");
        QTEST(std::round(rmc.position->longitude_deg * 1e7) / 1e7, "longitude");
        QVERIFY(rmc.time->hour == 9 && rmc.time->minute == 27 && rmc.time->second == 38);
        QVERIFY(!decodeText(summed("GPRMC,738,A," + position + ",0,0,100724"), rmc));
        QVERIFY(rmc.time->hour == 0 && rmc.time->minute == 7 && rmc.time->second == 38);
    }

    void anyTalkerIsRead() {
        for (const char *talker : {"GP", "GN", "GL", "GA", "GB", "BD"}) {
            Rmc rmc;
            QVERIFY(!decodeText(summed(QByteArray(talker) + "RMC,214106,A,3707.8178,N,12139.2690,W,,,230715"),
                                rmc));
            QVERIFY(rmc.valid);
            const auto text = encode(rmc, talker);
            QVERIFY(text && toBytes(text->view()).startsWith(QByteArray("$") + talker + "RMC,214106,A,"));
        }
    }

    void roundingStaysInTheField() {
        Rmc rmc;
        rmc.time = UtcTime{23, 59, 59.9999};
        rmc.position = Position{47.99999999999, -179.99999999999};
        rmc.course_deg = 359.99;
        rmc.valid = true;
        QVERIFY(encoded(rmc).startsWith("$GPRMC,235959,A,4800.0000,N,18000.0000,W,,000.0,"));
        QVERIFY(encoded(rmc, {0, 3}).startsWith("$GPRMC,235959.999,A,4800,N,18000,W,"));
        rmc.time = UtcTime{23, 59, 60.7}; // a leap second
        QVERIFY(encoded(rmc).startsWith("$GPRMC,235960,"));
        rmc.time = UtcTime{1, 2, 3.1};
        QVERIFY(encoded(rmc, {4, 2}).startsWith("$GPRMC,010203.10,"));
    }

    void doesNotWriteWhatDoesNotFit() {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        Rmc good;
        QVERIFY(!decodeText(realRmc, good));
        QVERIFY(!encoded(good).isEmpty());
        const auto refuses = [&good](auto change) {
            Rmc rmc = good;
            change(rmc);
            return encoded(rmc).isEmpty();
        };
        QVERIFY(refuses([&](Rmc &rmc) { rmc.position = Position{nan, 0}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.position = Position{90.001, 0}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.position = Position{0, -180.001}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.speed = nan; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.speed = -0.1; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.course_deg = 361; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.time = UtcTime{24, 0, 0}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.time = UtcTime{0, 0, nan}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.date = Date{1979, 1, 1}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.date = Date{2015, 2, 29}; }));
        QVERIFY(refuses([&](Rmc &rmc) { rmc.mode = ','; }));
        QVERIFY(encoded(good, {10, 0}).isEmpty() && encoded(good, {4, -1}).isEmpty());
        for (const char *talker : {"", "G", "GPS", "PG", "G,", "gp"})
            QVERIFY(!encode(good, talker));
        Gga gga;
        gga.quality = 10;
        QVERIFY(encoded(gga).isEmpty());
        gga.quality = 1;
        gga.hdop = std::numeric_limits<double>::infinity();
        QVERIFY(encoded(gga).isEmpty());
        SentenceText endless("GPTXT");
        for (int i = 0; i < 300; ++i)
            endless.addField("x");
        QVERIFY(!endless.finish() && endless.view().empty());
    }

    void neverAllocates() {
        SentenceParser parser;
        Rmc rmc;
        const std::size_t before = allocations;
        for (const char byte : realRmc) {
            if (parser.feed(byte) == SentenceParser::Result::Done)
                decode(parser.sentence(), rmc);
        }
        const auto text = encode(rmc);
        const std::size_t after = allocations;
        QCOMPARE(after, before);
        QVERIFY(text && rmc.valid);
    }
};
