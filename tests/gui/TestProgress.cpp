#include "tests/gui/VectorProgram.h"

/// Long work of hermes-vector tells how far it has come: people at a terminal, and programs by --json. Short
/// work is silent, and so is all work whose messages go elsewhere.
class TestProgress : public QObject {
    Q_OBJECT

    int terminal_ = -1; // our side of it
    QByteArray told_;   // so far
    QTemporaryDir folder_;

    QString path(const char *name) const { return folder_.filePath(QLatin1String(name)); }
    const QByteArray &told() {
        char text[4096];
        for (ssize_t size = 0; (size = ::read(terminal_, text, sizeof text)) > 0;)
            told_.append(text, int(size));
        return told_;
    }
    void start(QProcess &process, const QStringList &arguments) const {
        process.setStandardErrorFile(QString::fromLocal8Bit(::ptsname(terminal_)));
        process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-vector", arguments);
    }
    /// Some seconds of work.
    QStringList longWork(const char *summary) const {
        return {"map", path("long.log"), "--loops", "leave", "--summary", path(summary), "--force"};
    }
    /// A shell runs the command with $1 for the program and the others after it.
    static int shell(const QString &command, const QStringList &arguments) {
        QProcess process;
        process.start(
            "sh", QStringList{"-c", command, "sh", qEnvironmentVariable("HERMES_BIN") + "/hermes-vector"} +
                      arguments);
        return process.waitForFinished(60000) ? process.exitCode() : -1;
    }

private Q_SLOTS:
    void initTestCase() {
        QVERIFY(folder_.isValid());
        QFile log(path("long.log"));
        QVERIFY(log.open(QIODevice::WriteOnly));
        const QList<QByteArray> drive = contentOf(data("corrected.log")).split('\n');
        for (int stamp = 1; stamp <= 120000; ++stamp) {
            QList<QByteArray> scan = drive[stamp % drive.size()].split(' ');
            if (scan[0] != "FLASER")
                continue;
            scan.last() = scan[scan.size() - 3] = QByteArray::number(stamp);
            log.write(scan.join(' ') + '\n');
        }
    }
    void init() {
        told_.clear();
        terminal_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
        if (terminal_ < 0 || ::grantpt(terminal_) != 0 || ::unlockpt(terminal_) != 0)
            QSKIP("this machine gives no terminal");
    }
    void cleanup() { ::close(terminal_); }

    void shortWorkIsSilent() {
        QProcess process;
        start(process, {"map", data("corrected.log"), "--summary", "/dev/null"});
        QVERIFY(process.waitForFinished(30000));
        QCOMPARE(process.exitCode(), 0);
        QCOMPARE(told(), QByteArray());
        QCOMPARE(run({"map", data("corrected.log"), "--summary", "/dev/null", "--json"}).err, QByteArray());
    }
    void longWorkTellsHowFarItIs() {
        QProcess process;
        auto since = runningTimer();
        start(process, longWork("terminal"));
        QTRY_VERIFY_WITH_TIMEOUT(told().contains("tracking, step "), 20000);
        QVERIFY2(since.elapsed() >= 1000, saying(since.elapsed()));
        const QRegularExpression line("tracking, step \\d+ of \\d+ \\(\\d+ %\\), \\d+ s left");
        QTRY_VERIFY_WITH_TIMEOUT(line.match(QString::fromUtf8(told())).hasMatch(), 20000);
        QVERIFY(process.waitForFinished(60000));
        QCOMPARE(process.exitCode(), 0);
        QVERIFY2(told().endsWith("\r\033[K"), told().right(100).constData()); // the line is gone
    }
    void elsewhereItIsSilent() {
        const Result r = ran(longWork("silent"));
        QCOMPARE(r.err, QByteArray());
    }

    void jsonIsOneObjectALine() {
        auto since = runningTimer();
        const Result r = run(longWork("json") + QStringList("--json"));
        const double seconds = double(since.elapsed()) / 1000;
        QCOMPARE(r.status, 0);
        double done = 0, total = 0, elapsed = 0;
        QJsonObject last;
        const QList<QByteArray> lines = r.err.trimmed().split('\n');
        for (const QByteArray &line : lines) {
            const QJsonObject progress = json(line)["progress"].toObject();
            QVERIFY2(progress["left_s"].isNull() || progress["left_s"].toDouble() >= 0, line.constData());
            if (progress["what"].toString() != "tracking, step")
                continue;
            QVERIFY2(progress["done"].toDouble() >= done && progress["elapsed_s"].toDouble() >= elapsed,
                     line.constData());
            QVERIFY2(total == 0 || progress["total"].toDouble() == total, line.constData());
            done = progress["done"].toDouble();
            total = progress["total"].toDouble();
            elapsed = progress["elapsed_s"].toDouble();
            last = progress;
        }
        QVERIFY2(total > 0, r.err.constData());
        QCOMPARE(done, total);
        QCOMPARE(last["left_s"].toDouble(-1), 0.0);
        QVERIFY2(lines.size() <= 2 * seconds + 2, r.err.constData());
    }
    void jsonIsToldAtATerminalToo() {
        QProcess process;
        start(process, longWork("both") + QStringList("--json"));
        QVERIFY(process.waitForFinished(60000));
        QVERIFY2(told().startsWith("{\"progress\":"), told().constData());
    }
    void eachCommandTakesTheOption_data() {
        const Rows<QString> row("command");
        const QString help = QString::fromUtf8(run({"--help"}).out);
        QRegularExpressionMatchIterator commands =
            QRegularExpression("^  ([a-z-]+) ", QRegularExpression::MultilineOption)
                .globalMatch(help, help.indexOf("Subcommands:"));
        while (commands.hasNext()) {
            const QString name = commands.next().captured(1);
            if (name != "experiment" && name != "report") // of another program
                row(qPrintable(name), name);
        }
    }
    void eachCommandTakesTheOption() {
        QFETCH(QString, command);
        QVERIFY(run({command, "--help"}).out.contains("--json "));
    }

    // Who reads the progress may go: the result is written nevertheless.
    void resultOutlivesAReaderThatHasGone() {
        QCOMPARE(shell("{ \"$@\" --json 2>&1 >/dev/null; echo $? >" + path("status") + "; } | true",
                       longWork("unread")),
                 0);
        QCOMPARE(contentOf(path("status")), QByteArray("0\n"));
        QVERIFY(!json(contentOf(path("unread"))).isEmpty());
    }
    // The first file that is opened would be standard error.
    void closedStandardErrorIsNoFile() {
        QCOMPARE(shell("\"$@\" --json >/dev/null 2>&-", longWork("closed")), 0);
        QVERIFY(!json(contentOf(path("closed"))).isEmpty());
        QVERIFY(!contentOf(path("closed")).contains("progress"));
    }
};
