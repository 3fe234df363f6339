#include "protocol/nmea/Gll.h"
#include "protocol/nmea/Gns.h"
#include "protocol/nmea/Vtg.h"
#include "protocol/nmea/Zda.h"

using namespace hermes::nmea;

/// Of the sentences that are read and never written. The samples were made by hand after the descriptions.
class TestNmeaSentences : public QObject {
    Q_OBJECT

    template <typename Message>
    static Message read(const char *body, FieldFault &fault) {
        Message message;
        fault = decode(Sentence(body), message);
        return message;
    }

    template <typename Message>
    static int wrongField(const QByteArray &body) {
        Message message;
        const FieldFault fault = decode(Sentence({body.constData(), std::size_t(body.size())}), message);
        return fault ? fault.field : -1;
    }

private Q_SLOTS:
    void gllIsRead() {
        FieldFault fault;
        Gll gll = read<Gll>("GNGLL,4812.3000,S,01130.6000,W,081530.40,A,D", fault);
        QVERIFY2(!fault, fault.expected);
        QCOMPARE(gll.position->latitude_deg, -48 - 12.3 / 60);
        QCOMPARE(gll.position->longitude_deg, -11 - 30.6 / 60);
        QVERIFY(gll.time->hour == 8 && gll.time->minute == 15 && gll.time->second == 30.4 && gll.valid);
        gll = read<Gll>("GPGLL,,,,,,V", fault); // of an old receiver without a fix: no mode
        QVERIFY(!fault && !gll.position && !gll.time && !gll.valid);
    }

    void gnsIsRead() {
        FieldFault fault;
        Gns gns = read<Gns>("GNGNS,081530.00,4812.30000,N,01130.60000,E,AAN,14,0.7,520.1,46.9,,,V", fault);
        QVERIFY2(!fault, fault.expected);
        QCOMPARE(gns.position->latitude_deg, 48 + 12.3 / 60);
        QVERIFY(gns.quality == 1 && gns.satellites == 14 && gns.hdop == 0.7 && gns.altitude == 520.1);
        // One constellation's part of the one before.
        gns = read<Gns>("GLGNS,081530.00,,,,,,6,,,,3.0,23", fault);
        QVERIFY2(!fault, fault.expected);
        QVERIFY(gns.time && !gns.position && !gns.quality && gns.satellites == 6);
        gns = read<Gns>("GNGNS,081530.00,,,,,NN,0,99.99,,,x,y,z", fault);
        QVERIFY(!fault && gns.quality == 0);
    }

    void modesOfGns_data() {
        const Rows<int> row("quality");
        const std::pair<const char *, int> modes[] = {
            {"A", 1},  {"NA", 1}, {"AD", 2}, {"DA", 2}, {"NNR", 4},  {"RF", 4}, {"F", 5},     {"P", 3},
            {"EN", 6}, {"M", 7},  {"S", 8},  {"N", 0},  {"NNNN", 0}, {"AE", 1}, {"AAAAAA", 1}};
        for (const auto &[mode, quality] : modes)
            row(mode, quality);
    }

    void modesOfGns() {
        FieldFault fault;
        const QByteArray body =
            QByteArray("GNGNS,081530,4812.3,N,01130.6,E,") + QTest::currentDataTag() + ",14,0.7,520.1,46.9,,";
        const Gns gns = read<Gns>(body.constData(), fault);
        QVERIFY(!fault);
        QTEST(*gns.quality, "quality");
    }

    void vtgIsRead() {
        FieldFault fault;
        Vtg vtg = read<Vtg>("GPVTG,271.50,T,268.1,M,010.00,N,018.5,K,A", fault);
        QVERIFY2(!fault, fault.expected);
        QCOMPARE(*vtg.course_deg, 271.5);
        QVERIFY(std::abs(*vtg.speed - 5.14444) < 1e-5);
        vtg = read<Vtg>("GNVTG,,T,,M,,N,18.0,K", fault);
        QVERIFY(!fault && !vtg.course_deg);
        QCOMPARE(*vtg.speed, 5.0);
        vtg = read<Vtg>("GPVTG,,,,,,,,,N", fault);
        QVERIFY(!fault && !vtg.course_deg && !vtg.speed);
        vtg = read<Vtg>("GPVTG,-90.0,T,-95.2,M,5.0,N,9.3,K", fault); // one does not cost the other
        QVERIFY(!fault && !vtg.course_deg && vtg.speed);
        vtg = read<Vtg>("GPVTG,5.0,T,999.9,,0.0,N,0.0,K,x", fault); // what is not used
        QVERIFY(!fault && vtg.speed == 0.0);
    }

    void zdaIsRead() {
        FieldFault fault;
        Zda zda = read<Zda>("GPZDA,235960.50,31,12,2016,00,00", fault);
        QVERIFY2(!fault, fault.expected);
        QCOMPARE(zda.time->second, 60.5);
        QVERIFY(zda.date->year == 2016 && zda.date->month == 12 && zda.date->day == 31);
        zda = read<Zda>("GPZDA,081530,01,02,2030", fault);
        QVERIFY(!fault && zda.date->year == 2030);
        zda = read<Zda>("GNZDA,081530,,,,x,", fault);
        QVERIFY(!fault && zda.time && !zda.date);
    }

    void wrongFieldsAreNamed_data() {
        Rows<QByteArray, int>("body", "field");
        const auto row = [](const char *body, int field) {
            QTest::newRow(body) << QByteArray(body) << field;
        };
        row("GPGLL,4860.0,N,01130.6,E,081530,A,A", 1);
        row("GPGLL,4812.3,,01130.6,E,081530,A,A", 1);
        row("GPGLL,4812.3,N,18012.3,E,081530,A,A", 3);
        row("GPGLL,4812.3,N,01130.6,E,086030,A,A", 5);
        row("GPGLL,4812.3,N,01130.6,E,081530,,A", 6);
        row("GPGLL,4812.3,N,01130.6,E,081530,X,A", 6);
        row("GPGLL,4812.3,N,01130.6,E", 0);
        row("GPGLL,nan,N,01130.6,E,xx,V,N", -1); // without a fix
        row("GPGNS,081530,-,-,-,-,NN,14,0.7,520.1,46.9,,", -1);
        row("GPGNS,240000,4812.3,N,01130.6,E,A,14,0.7,520.1,46.9,,", 1);
        row("GPGNS,081530,9100.0,N,01130.6,E,A,14,0.7,520.1,46.9,,", 2);
        row("GPGNS,081530,4812.3,N,01130.6,E,AX,14,0.7,520.1,46.9,,", 6);
        row("GPGNS,081530,4812.3,N,01130.6,E,,14,0.7,520.1,46.9,,", 6);
        row("GPGNS,081530,4812.3,N,01130.6,E,A,1.5,0.7,520.1,46.9,,", -1);
        row("GPGNS,081530,4812.3,N,01130.6,E,A,14,-1,520.1,46.9,,", -1);
        row("GPGNS,081530,4812.3,N,01130.6,E,A,14,0.7,inf,46.9,,", -1);
        row("GPGNS,081530,4812.3,N,01130.6,E,A", 0);
        row("GPVTG,361,T,,M,1.0,N,1.9,K", -1);
        row("GPVTG,36.1,M,,M,1.0,N,1.9,K", -1);
        row("GPVTG,36.1,T,,M,-1.0,N,1.9,K", -1);
        row("GPVTG,36.1,T,,M,1.0,,1.9,K", -1);
        row("GPVTG,36.1,T,,M,,N,1.9,N", -1);
        row("GPVTG,36.1,T", 0);
        row("GPZDA,x,31,12,2016,00,00", 1);
        row("GPZDA,235959,31,11,2016,00,00", -1);
        row("GPZDA,235959,31,,2016,00,00", -1);
        row("GPZDA,235959,31,13,2016,00,00", -1);
        row("GPZDA,235959,31,12,16,00,00", -1);
        row("GPZDA,235959", 0);
    }

    void wrongFieldsAreNamed() {
        QFETCH(QByteArray, body);
        const QByteArray type = body.mid(2, 3);
        const int found = type == "GLL"   ? wrongField<Gll>(body)
                          : type == "GNS" ? wrongField<Gns>(body)
                          : type == "VTG" ? wrongField<Vtg>(body)
                                          : wrongField<Zda>(body);
        QTEST(found, "field");
    }
};
