// What emulated laser scanners that are asked in texts answer, by what their makers published.
#include "ScannerBench.h"

namespace {

/// A text of CoLa A.
QByteArray cola(const QByteArray &text) {
    return '\x02' + text + '\x03';
}

/// Whole telegrams, and the text of the last one.
struct Telegrams {
    int count = 0;
    QList<QByteArray> last;

    explicit Telegrams(const QByteArray &bytes) {
        for (const QByteArray &text : bytes.left(bytes.lastIndexOf('\x03')).split('\x03')) {
            if (text.startsWith("\x02sSN LMDscandata ")) {
                ++count;
                last = text.split(' ');
            }
        }
    }
};

} // namespace

class TestScannerTexts : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void scipAnswersAsPublished() {
        Bench urg("hokuyo-urg04lx");
        QCOMPARE(urg.ask("QT\n"), QByteArray("QT\n00P\n\n"));
        QVERIFY(urg.ask("PP\n").endsWith("DMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\nAMAX:725;o\n"
                                         "AFRT:384;6\nSCAN:600;e\n\n"));
        QVERIFY(urg.ask("VV\n").contains("\nPROT:SCIP 2.0;N\n"));
        QVERIFY(urg.ask("II\n").contains("\nSTAT:Sensor works well.;8\n"));
        QCOMPARE(urg.ask("BM\n"), QByteArray("BM\n00P\n\n"));
        QCOMPARE(urg.ask("BM\n"), QByteArray("BM\n02R\n\n"));
        QCOMPARE(urg.ask("TM0\n"), QByteArray("TM0\n00P\n\n"));
        QCOMPARE(urg.ask("BM\n"), QByteArray("BM\n0Ee\n\n"));
        const QByteArray time = urg.ask("TM1\n");
        QVERIFY2(time.startsWith("TM1\n00P\n") && scipLine(time.mid(8, 5)).size() == 4, time.constData());
        QCOMPARE(urg.ask("TM2\n"), QByteArray("TM2\n00P\n\n"));
        QCOMPARE(urg.ask("MD0700099900001\n"), QByteArray("MD0700099900001\n02R\n\n"));
        QCOMPARE(Bench("hokuyo-ust10lx").ask("SS115200\n"), QByteArray("SS115200\n0Ff\n\n"));
        // The published measurement: 1000 and 1001 mm, then nothing.
        Bench ust("hokuyo-ust10lx");
        ust.measure = [](double angle) { return angle < 0.002 ? 1 : angle < 0.006 ? 1.001 : 0; };
        const QByteArray told = ust.ask("MD0540054201002\n", 0.2);
        QVERIFY2(told.startsWith("MD0540054201002\n00P\n\nMD0540054201001\n99b\n"), told.constData());
        QCOMPARE(told.count("\n99b\n"), 2);
        QCOMPARE(told.count("\n0?X0?Y000O\n\n"), 2);
        QVERIFY(told.contains("\nMD0540054201000\n99b\n"));
        // One of three, nearest of each four steps.
        QCOMPARE(ust.ask("MD0540054304200\n", 0.3).count("\n000@\n"), 4);
        QVERIFY(ust.ask("QT\n").endsWith("QT\n00P\n\n"));
        QCOMPARE(ust.pass(0.2), QByteArray());
        QCOMPARE(ust.ask("GD0540054200\n"), QByteArray("GD0540054200\n0Aa\n\n"));
        ust.ask("BM\n");
        const QByteArray once = ust.ask("GD0540054200\n", 0.2);
        QVERIFY2(once.startsWith("GD0540054200\n00P\n") && once.count("GD") == 1, once.constData());
    }

    void colaAnswersAsPublished_data() {
        Rows<QByteArray, QByteArray> row("sent", "answer");
        row("login", "sMN SetAccessMode 3 F4724744", "sAN SetAccessMode 1");
        row("login, other numbers", "sMN SetAccessMode 03 F4724744", "sAN SetAccessMode 1");
        row("wrong password", "sMN SetAccessMode 3 12345678", "sAN SetAccessMode 0");
        row("CoLa A", "sWN EIHstCola 0", "sWA EIHstCola");
        row("CoLa B", "sWN EIHstCola 1", "sFA 5");
        row("state", "sRN SCdevicestate", "sRA SCdevicestate 1");
        row("sector", "sRN LMPoutputRange", "sRA LMPoutputRange 1 2710 FFF92230 225510");
        row("contents", "sWN LMDscandatacfg 1 0 1 0 0 0 0 0 0 0 1 0 1", "sWA LMDscandatacfg");
        row("contents, too few", "sWN LMDscandatacfg 1 0", "sFA 5");
        row("start", "sMN LMCstartmeas", "sAN LMCstartmeas 0");
        row("run", "sMN Run", "sAN Run 1");
        row("stop of telegrams", "sEN LMDscandata 0", "sEA LMDscandata 0");
        row("other variable", "sRN NoSuchThing", "sFA 3");
        row("other method", "sMN NoSuchThing", "sFA 2");
        row("other event", "sEN NoSuchThing 1", "sFA F");
        row("other command", "sXN LMDscandata", "sFA C");
        row("no name", "sRN", "sFA 3");
        row("nothing", "", "");
    }

    void colaAnswersAsPublished() {
        FETCH(QByteArray, sent, QByteArray, answer);
        Bench tim("sick-tim551");
        QCOMPARE(tim.ask(cola("sMN SetAccessMode 3 F4724744")), cola("sAN SetAccessMode 1"));
        QCOMPARE(tim.ask("junk" + cola(sent)), answer.isEmpty() ? QByteArray() : cola(answer));
    }

    void colaNeedsALoginToChangeAnything() {
        Bench tim("sick-tim551");
        QCOMPARE(tim.ask(cola("sMN LMCstartmeas")), cola("sFA 1"));
        QCOMPARE(tim.ask(cola("sWN EIHstCola 0")), cola("sFA A"));
        tim.ask(cola("sMN SetAccessMode 3 F4724744"));
        QCOMPARE(tim.ask(cola("sWN EIHstCola 0")), cola("sWA EIHstCola"));
        tim.ask(cola("sMN Run"));
        QCOMPARE(tim.ask(cola("sWN EIHstCola 0")), cola("sFA A"));
    }

    void colaBGetsNoAnswer() {
        Bench tim("sick-tim551");
        QCOMPARE(tim.ask(fromHex("0202020200000011") + "sEN LMDscandata \x01\x33"), QByteArray());
        QCOMPARE(tim.ask(fromHex("0202020200000017") + "sMN SetAccessMode \x03\xF4\x72\x47\x44\xB3"),
                 QByteArray());
        QCOMPARE(tim.ask(cola("sRN SCdevicestate")), cola("sRA SCdevicestate 1"));
    }

    void telegramsAreAsPublished_data() {
        Rows<QString, QByteArray, double> row("model", "numbers", "turn_s");
        row("TiM551", "sick-tim551", "0 0 1 0 0 5DC 36 0 1 DIST1 3F800000 00000000 FFF92230 2710 10F",
            1 / 15.0);
        row("TiM571", "sick-tim571", "0 0 1 0 0 5DC A2 0 1 DIST1 3F800000 00000000 FFF92230 D05 32B",
            1 / 15.0);
        row("LMS111", "sick-lms111", "0 0 1 0 0 1388 168 0 1 DIST1 3F800000 00000000 FFF92230 1388 21D",
            1 / 50.0);
    }

    void telegramsAreAsPublished() {
        FETCH(QString, model, QByteArray, numbers, double, turn_s);
        Bench bench(model);
        QVERIFY(bench.ask(cola("sEN LMDscandata 1"), 0.01).startsWith(cola("sEA LMDscandata 1")));
        const QByteArray sent = bench.pass(3);
        const Telegrams telegrams(sent);
        QVERIFY2(std::abs(telegrams.count - 3 / turn_s) <= 1, qPrintable(QString::number(telegrams.count)));
        const QList<QByteArray> &words = telegrams.last;
        QCOMPARE(words.mid(1, 6).join(' '), QByteArray("LMDscandata 1 1 F510AB 0 0"));
        QCOMPARE(words.mid(11, 15).join(' '), numbers);
        QCOMPARE(words.mid(26 + words[25].toInt(nullptr, 16)).join(' '),
                 QByteArray("0 0 1 B not defined 0 0 0"));
        // Of the zero index at the rear, and 315 degrees later.
        const std::vector<double> stamps = readCola(sent).stamps;
        for (std::size_t i = 2; i < stamps.size(); i += 2) {
            QVERIFY(std::abs(stamps[i] - stamps[i - 2] - turn_s) < 3e-6);
            QVERIFY(std::abs(stamps[i + 1] - stamps[i] - turn_s * 315 / 360) < 3e-6);
        }
        bench.ask(cola("sEN LMDscandata 0"), 0.2);
        QCOMPARE(bench.pass(0.2), QByteArray());
        const QByteArray once = bench.ask(cola("sRN LMDscandata"), 0.3);
        QVERIFY(once.startsWith("\x02sRA LMDscandata 1 1 ") && once.count('\x02') == 1);
    }

    void whatIsNoRangeIsACode() {
        Bench tim("sick-tim551");
        tim.measure = [](double angle) { return angle < -1 ? 0 : angle < 0 ? 0.010 : angle < 1 ? 9.9 : 12; };
        tim.scan();
        int codes = 0, ranges = 0;
        for (const QByteArray &word : Telegrams(tim.pass(0.3)).last.mid(26, 271)) {
            const int value = word.toInt(nullptr, 16);
            QVERIFY(value < 16 || value == 9900);
            (value < 16 ? codes : ranges) += 1;
        }
        QVERIFY(ranges == 57 || ranges == 58); // a radian of them
        QCOMPARE(codes + ranges, 271);
    }

    void contentsFollowTheSettings_data() {
        const Rows<QByteArray, int, QByteArray, int> row("settings", "period", "channels", "at");
        row("8 bits", "1 0 1 0 0 0 0 0 0 0 1 0 1", 1, "1", 27 + 271);
        row("16 bits", "1 0 1 1 0 0 0 0 0 0 1 0 1", 1, "2", 26 + 271);
        row("each third", "1 0 0 0 0 0 0 0 0 0 1 0 3", 3, "1", -1);
    }

    void contentsFollowTheSettings() {
        FETCH(QByteArray, settings, int, period, QByteArray, channels, int, at);
        Bench tim("sick-tim551");
        tim.ask(cola("sMN SetAccessMode 3 F4724744"));
        tim.ask(cola("sWN LMDscandatacfg " + settings));
        tim.scan();
        const QByteArray sent = tim.pass(3);
        const Telegrams telegrams(sent);
        QVERIFY(std::abs(telegrams.count - 45 / period) <= 1);
        QCOMPARE(telegrams.last[19], channels);
        QCOMPARE(telegrams.last.indexOf("RSSI1"), at);
        QCOMPARE(telegrams.last.mid(telegrams.last.size() - 8).join(' '),
                 QByteArray("0 1 B not defined 0 0 0"));
        QCOMPARE(readCola(sent).points[100].intensity > 0, at > 0);
    }

    void brokenSickTellsSo() {
        Bench tim("sick-tim551");
        tim.scan();
        QCOMPARE(Telegrams(tim.pass(0.2)).last[6], QByteArray("0"));
        tim.scanner->setFault({ScannerEmulator::Fault::Kind::Health, 0});
        QCOMPARE(Telegrams(tim.pass(0.2)).last[6], QByteArray("1"));
        QVERIFY(tim.ask(cola("sRN SCdevicestate"), 0.2).contains("SCdevicestate 2"));
        tim.ask(cola("sMN SetAccessMode 3 F4724744"));
        QVERIFY(tim.ask(cola("sMN mSCreboot"), 0.2).endsWith(cola("sAN mSCreboot")));
        QCOMPARE(tim.ask(cola("sRN SCdevicestate"), 0.2), cola("sRA SCdevicestate 1"));
    }

    // What a program asked for ends with its connection.
    void scansEndWithTheConnection_data() { rowsOf<QString>("model", {"hokuyo-ust10lx", "sick-lms111"}); }

    void scansEndWithTheConnection() {
        QFETCH(QString, model);
        const QByteArray ask = model == "hokuyo-ust10lx" ? QByteArray("QT\n") : cola("sRN SCdevicestate");
        Bench bench(model);
        bench.scan();
        QVERIFY(bench.read(bench.pass(0.5)).packets > 10);
        bench.ask(ask.left(1), 0); // it does not finish
        bench.scanner->disconnect();
        QCOMPARE(bench.pass(0.5), QByteArray());
        QVERIFY(bench.ask(ask).contains(model == "hokuyo-ust10lx" ? "QT\n00P" : "SCdevicestate 1"));
    }
};
