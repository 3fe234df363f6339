#include "tests/gui/VectorProgram.h"

#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

/// hermes-vector with a terminal for its messages: long work tells how far it has come, short work is silent.
class TestProgress : public QObject {
    Q_OBJECT

    int terminal_ = -1; // our side of it
    QByteArray told_;   // so far

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

private Q_SLOTS:
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
    }
    void longWorkTellsHowFarItIs() {
        QTemporaryDir folder;
        QProcess process;
        QElapsedTimer since;
        since.start();
        start(process, {"experiment", "dispersion", "--runs", "10000", "--out", folder.filePath("results")});
        QTRY_VERIFY_WITH_TIMEOUT(told().contains("run "), 20000);
        QVERIFY2(since.elapsed() >= 1000, qPrintable(QString::number(since.elapsed())));
        process.terminate();
        QVERIFY(process.waitForFinished(30000));
    }
};

QTEST_GUILESS_MAIN(TestProgress)
#include "TestProgress.moc"
