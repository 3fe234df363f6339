#include "tests/gui/VectorProgram.h"
#include "tests/support/Latex.h"

/// hermes-vector when something is wrong: exit status, message, and no trace of a file.
class TestVectorFailures : public QObject, protected TestFolder {
    Q_OBJECT

private Q_SLOTS:
    void init() { empty(); }

    void wrongUsage_data() {
        const Rows<QStringList, QByteArray> row("arguments", "named");
        const QString room = data("room.csv"), world = data("world.json"), log = data("raw.log");
        row("nothing", {}, "subcommand");
        row("no such command", {"draw"}, "draw");
        row("no file", {"segment"}, "IN");
        row("unknown option", {"segment", room, "--colour", "red"}, "--colour");
        row("no number", {"segment", room, "--k", "many"}, "--k");
        row("not a number", {"segment", room, "--min-threshold", "nan"}, "--min-threshold");
        row("negative", {"segment", room, "--min-points", "-1"}, "--min-points");
        row("bounds crossed", {"segment", room, "--min-threshold", "0.5"}, "--min-threshold");
        row("sigma 0", {"vectorize", room, "--sigma", "0"}, "--sigma");
        row("unknown algorithm", {"vectorize", room, "--algorithm", "magic"}, "--algorithm");
        row("unknown weights", {"register", data("pairs.csv"), "--weights", "heavy"}, "--weights");
        row("no pose", {"observe", world}, "--pose");
        row("no motion", {"similarity", data("pairs.csv")}, "--pose");
        row("half a motion", {"similarity", data("pairs.csv"), "--pose", "1,2"}, "--pose");
        row("half a pose", {"observe", world, "--pose", "1,2"}, "--pose");
        row("noise without scan", {"observe", world, "--pose", "0,0,0", "--noise", "1"}, "--noise");
        row("noise of directions without scan", {"observe", world, "--pose", "0,0,0", "--angle-noise", "1"},
            "--angle-noise");
        row("field of view", {"observe", world, "--pose", "0,0,0", "--fov", "400"}, "--fov");
        row("unknown map", {"map", log, "--out-map", "map.png"}, "--out-map");
        row("scan beyond all", {"map", log, "--scan", "1e15"}, "found \"1e15\", expected a whole number");
        row("half a scan", {"map", log, "--scan", "1.5"}, "found \"1.5\", expected a whole number");
        row("no whole number", {"segment", room, "--k", "2.5"}, "found \"2.5\", expected a whole number");
        row("every 0th", {"map", log, "--every", "0"}, "--every");
        row("odometry", {"map", log, "--odometry", "maybe"}, "--odometry");
        row("half a mount", {"map", log, "--sensor", "1,2"}, "--sensor: found \"1,2\"");
        row("mount in degrees", {"map", log, "--sensor", "0,0,180"}, "did you mean 3.142 rad (180 degrees)?");
        row("off the robot", {"map", log, "--sensor", "1e9,0,0"}, "within 100 m");
        row("over a turn", {"map", log, "--sensor", "0,0,450deg"}, "is 1.25 turns");
        row("no angle", {"map", log, "--sensor", "0,0,deg"}, "--sensor");
        row("mount of one scan", {"map", log, "--sensor", "0,0,0", "--scan", "1"}, "--sensor");
        row("field of no view", {"map", log, "--field-of-view", "0"}, "--field-of-view");
        row("no range", {"map", log, "--max-range", "0"}, "--max-range");
        for (const char *option : {"--sensor=0,0,0", "--field-of-view=180", "--max-range=8"})
            row(option, {"map", TEST_DATA_DIR, option}, ": only of a CARMEN log");
        row("laser 32", {"ring", "x.pcap", "--laser", "32"}, "--laser");
        row("port 0", {"ring", "x.pcap", "--port", "0"}, "--port");
        row("no address", {"map", "x.pcap", "--sender", "sensor"}, "--sender");
        for (const char *address :
             {"0x10.0.0.1", "010.0.0.1", "10.0.0.256", "10.0.0", "10.0.0.1.", "10..0.1", "10.0.0.1.2"})
            row(address, {"map", "x.pcap", "--sender", address}, "--sender");
        row("port of no capture", {"map", log, "--port", "2368"}, "--port: only of a capture");
        row("sender of no capture", {"map", log, "--sender", "10.0.0.1"}, "--sender: only of a capture");
        row("unknown option and its value", {"map", log, "--ouy", "x", "--every", "2"},
            ": unknown option --ouy\n");
        row("one file more", {"map", log, "b.log", "c.log"}, ": unexpected argument b.log\n");
        row("unknown command and its arguments", {"mapx", log}, ": unknown command mapx\n");
        row("no value", {"segment", room, "--k"}, "--k: a value is missing, expected N");
        row("one file twice", {"map", log, "--summary", path("s"), "--out", path("s")},
            "--summary or --out: given 2 times, expected once");
        row("offsets without z", {"ring", "x.pcap", "--no-vertical-offsets"}, "--all");
    }
    void wrongUsage() {
        FETCH(QStringList, arguments, QByteArray, named);
        const Result r = run(arguments);
        refused(r, 2, named);
        QCOMPARE(r.out, QByteArray());
    }

    void badInput_data() {
        const Rows<QString, QByteArray, QByteArray, QByteArray> row("command", "text", "place", "expected");
        const QByteArray log = contentOf(data("raw.log"));
        row("a word in points", "segment", "x,y\n1,2\none,3\n", "in:3:", "a finite number");
        row("one column", "vectorize", "1,2\n3\n", "in:2:", "2 fields");
        row("no pairs", "register", "1,2,3,4\n", "in:1:", "dx1");
        row("empty pairs", "register", QByteArray(), "in", "an empty file");
        row("pair of no length", "register", "0,0,1,0,2,2,2,2\n", "in:1:", "distinct");
        row("weight 0", "register", "sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2,weight\n0,0,1,0,0,0,1,0,0\n",
            "in:2:", "above 0");
        row("pairs beyond measure", "register", "0,0,1,0,0,0,1,0\n0,1e160,1,1e160,0,0,1,0\n",
            "in:", "far too large");
        row("world without edges", "observe", "{\"name\": \"x\", \"edges\": []}", "in", "x1");
        row("world that is none", "observe", "{\"edges\": [\n[0,0,1]]}", "in:2", QByteArray());
        row("log cut short", "map", log.left(log.size() / 2), "in:8:", "of FLASER");
        row("no log", "map", "hello\n", "in:1:", "CARMEN");
        row("no capture", "ring", "hello\n", "in", QByteArray());
        row("empty file", "map", QByteArray(), "in", "FLASER");
    }
    /// Status 1, a message that names the place, and not a trace of any output file.
    void badInput() {
        FETCH(QString, command, QByteArray, text, QByteArray, place, QByteArray, expected);
        put(path("in"), text);
        QStringList arguments{command, path("in"), "--out", path("out")};
        if (command == QLatin1String("observe"))
            arguments += {"--pose", "0,0,0"};
        if (command == QLatin1String("map"))
            arguments +=
                {"--out-map", path("m.csv"), "--out-trajectory", path("t.tum"), "--svg", path("m.svg")};
        const Result r = run(arguments);
        QVERIFY2(r.status == 1, r.err.constData());
        QVERIFY2(r.err.contains('/' + place), r.err.constData());
        QVERIFY2(r.err.contains(expected), r.err.constData());
        QCOMPARE(files(), QStringList{"in"});
    }

    void captureCutInMidRecord() {
        writeCapture(path("whole.pcap"), 250);
        put(path("c.pcap"), contentOf(path("whole.pcap")).left(200 * 1264 + 500));
        QFile::remove(path("whole.pcap"));
        for (const char *command : {"ring", "map"}) {
            refused(run({command, path("c.pcap"), "--out", path("out")}), 1, "c.pcap: record 2");
            QCOMPARE(files(), QStringList{"c.pcap"});
        }
    }

    void damagedLinesAreCountedOnDemand() {
        QByteArray log = contentOf(data("raw.log"));
        put(path("in"), log.left(log.size() / 2));
        const Result r = ran({"map", path("in"), "--skip-damaged"});
        QCOMPARE(json(r.out)["damaged_lines"].toInt(), 1);
        QVERIFY2(r.err.contains("in:8: found a line cut short"), r.err.constData());
    }

    void nothingIsOverwritten() {
        put(path("out"), "precious");
        refused(run({"segment", data("room.csv"), "--out", path("out"), "--svg", path("new.svg")}), 1,
                "--force");
        QCOMPARE(contentOf(path("out")), QByteArray("precious"));
        QCOMPARE(files(), QStringList{"out"});
        ran({"segment", data("room.csv"), "--out", path("out"), "--force"});
        QVERIFY(contentOf(path("out")).startsWith("index,cluster\n"));
        QCOMPARE(run({"segment", data("room.csv"), "--out", path("a"), "--svg", path("a")}).status, 1);
        QCOMPARE(run({"segment", data("room.csv"), "--out", path("no/such/folder")}).status, 1);
        QCOMPARE(files(), QStringList{"out"});
    }

    void picturesAreNamedAsWhatTheyAre_data() {
        const Rows<QString> row("name");
        row("png", "a.png");
        row("compressed", "a.svg.gz");
        row("capitals", "a.PNG");
    }
    void picturesAreNamedAsWhatTheyAre() {
        QFETCH(QString, name);
        const QString picture = path(qPrintable(name));
        for (const QStringList &command :
             {QStringList{"segment", data("room.csv")}, QStringList{"map", data("corrected.log")}}) {
            refused(run(command + QStringList{"--svg", picture}), 2,
                    "--svg: found " + picture.toUtf8() + ", expected a name that ends with .svg");
            QVERIFY(files().isEmpty());
        }
    }
    void latexIsAPictureToo_data() {
        const Rows<QStringList> row("command");
        const QString room = data("room.csv");
        row("segment", {"segment", room});
        row("vectorize", {"vectorize", room});
        row("match", {"match", room, room});
        row("register", {"register", data("pairs.csv")});
        row("observe", {"observe", data("world.json"), "--pose", "0,0,0"});
    }
    /// --latex has the rules of --svg.
    void latexIsAPictureToo() {
        QFETCH(QStringList, command);
        const QStringList whole = command + QStringList{"--out", path("o"), "--latex", path("p.tex")};
        refused(run(command + QStringList{"--latex", path("p.svg")}), 2,
                "p.svg, expected a name that ends with .tex");
        QVERIFY(files().isEmpty());
        put(path("p.tex"), "precious");
        QCOMPARE(run(whole).status, 1);
        QCOMPARE(contentOf(path("p.tex")), QByteArray("precious"));
        QCOMPARE(files(), QStringList{"p.tex"});
        ran(whole + QStringList{"--svg", path("p.svg"), "--force"});
        QCOMPARE(files(), (QStringList{"o", "p.svg", "p.tex"}));
        const QByteArray text = contentOf(path("p.tex"));
        QVERIFY(text.startsWith("\\documentclass") && text.endsWith("\\end{document}\n"));
        QVERIFY(text.contains("{x [m]}") && text.contains("\\mbox{\\tikz"));
        const hermes::Latex latex;
        if (!latex.missing().isEmpty())
            QSKIP(latex.missing().constData());
        const QByteArray fault = hermes::Latex::fault(path("p.tex"));
        QVERIFY2(fault.isEmpty(), fault.constData());
    }
    void longNamesAreToldBeforeTheWork() {
        const QString name = path(QByteArray(300, 'n').constData());
        refused(run({"segment", path("missing.csv"), "--out", name}), 1,
                "nnn: cannot be written: File name too long");
    }

    void killLeavesNoFile_data() { falseAndTrue("isThere", "new file", "instead of another"); }
    /// The program waits for the rest of its input when it is killed: nothing it could do about its files.
    void killLeavesNoFile() {
        QFETCH(bool, isThere);
        const int probe = ::open(qPrintable(path()), O_TMPFILE | O_WRONLY, 0600);
        if (probe < 0)
            QSKIP("this file system knows no files without a name");
        ::close(probe);
        if (isThere)
            put(path("scan.csv"), "precious");
        QProcess process;
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-vector",
                      {"map", "-", "--scan", "1", "--out", path("scan.csv"), "--force"});
        process.write(contentOf(data("corrected.log")));
        const QString handles = QStringLiteral("/proc/%1/fd").arg(process.processId());
        const auto holds = [&] { // the file that it writes
            for (const QFileInfo &file : QDir(handles).entryInfoList(QDir::AllEntries | QDir::System))
                if (file.symLinkTarget().startsWith(path()))
                    return true;
            return false;
        };
        QTRY_VERIFY_WITH_TIMEOUT(holds(), 30000);
        process.kill();
        QVERIFY(process.waitForFinished(30000));
        QCOMPARE(files(), isThere ? QStringList{"scan.csv"} : QStringList());
        if (isThere)
            QCOMPARE(contentOf(path("scan.csv")), QByteArray("precious"));
    }

    void closedPipe_data() {
        const Rows<QStringList, QStringList> row("arguments", "complete");
        const QString room = data("room.csv");
        const QStringList match{"match", room, room, "--force"};
        row("table", {"segment", room}, QStringList());
        row("picture beside it", match + QStringList{"--svg", path("m.svg")}, {"m.svg"});
        row("file beside the picture", match + QStringList{"--svg", "-", "--out", path("m.json")},
            {"m.json"});
        row("picture to another pipe", match + QStringList{"--svg", "/dev/stdout", "--out", path("m.json")},
            {"m.json"});
        row("map beside the summary",
            {"map", data("corrected.log"), "--out-map", path("m.csv"), "--svg", path("m.svg")},
            {"m.csv", "m.svg"});
    }
    /// The reader of the pipe has gone before the program starts: the files are complete, and what is missing
    /// is told.
    void closedPipe() {
        FETCH(QStringList, arguments, QStringList, complete);
        QProcess shell;
        shell.start("bash", QStringList{"-c", "exec 3> >(true); wait $!; \"$@\" >&3", "bash",
                                        qEnvironmentVariable("HERMES_BIN") + "/hermes-vector"} +
                                arguments);
        QVERIFY(shell.waitForFinished(60000));
        const QByteArray said = shell.readAllStandardError();
        QVERIFY2(shell.exitStatus() == QProcess::NormalExit && shell.exitCode() == 1, said.constData());
        QVERIFY2(said.contains("cannot be written to its end: its reader has gone"), said.constData());
        QCOMPARE(files(), complete);
        for (const QString &name : complete)
            QVERIFY(contentOf(path(qPrintable(name))).size() > 100);
    }
    void fullDevice() {
        const Result r =
            run({"match", data("room.csv"), data("room.csv"), "--out", "/dev/full", "--svg", path("m.svg")});
        refused(r, 1, "/dev/full: cannot be written to its end: ");
        QVERIFY2(r.err.toLower().contains("no space left"), r.err.constData());
        QCOMPARE(files(), QStringList{"m.svg"});
    }
    /// A reader that has seen enough ends the reading of a long capture.
    void closedPipeEndsALongRing() {
        writeCapture(path("long.pcap"), 4000);
        QProcess shell;
        shell.start("bash", {"-c", "\"$@\" | head -n 1", "bash",
                             qEnvironmentVariable("HERMES_BIN") + "/hermes-vector", "ring", path("long.pcap"),
                             "--all"});
        QVERIFY(shell.waitForFinished(60000));
        QVERIFY(shell.readAllStandardOutput().startsWith("turn,stamp"));
        const QByteArray said = shell.readAllStandardError();
        QVERIFY2(said.contains("standard output: cannot be written"), said.constData());
    }
};
