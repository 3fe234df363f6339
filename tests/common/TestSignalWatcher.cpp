#include "common/daemon/SignalWatcher.h"

#include <sys/wait.h>

using namespace hermes;

class TestSignalWatcher : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void namesWhatCame_data() {
        const Rows<int> row("number");
        row("SIGINT", SIGINT);
        row("SIGTERM", SIGTERM);
        row("SIGHUP", SIGHUP);
    }

    void namesWhatCame() {
        QFETCH(int, number);
        SignalWatcher watcher(nullptr);
        QSignalSpy received(&watcher, &SignalWatcher::received);
        ::raise(number);
        QTRY_COMPARE(received.size(), 1);
        QCOMPARE(received[0][0].toString(), QString(QTest::currentDataTag()));
    }

    // A child that is ended before it has become another program must not end this one.
    void signalForAForkedChildIsNotForTheParent() {
#ifdef __SANITIZE_THREAD__
        QSKIP("the thread sanitizer holds signals back");
#endif
        SignalWatcher watcher(nullptr);
        QSignalSpy received(&watcher, &SignalWatcher::received);
        const pid_t child = ::fork();
        if (child == 0) {
            ::raise(SIGTERM);
            ::_exit(0);
        }
        QVERIFY(child > 0);
        int status = 0;
        QCOMPARE(::waitpid(child, &status, 0), child);
        QVERIFY(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
        QTest::qWait(0);
        QCOMPARE(received.size(), 0);
        ::raise(SIGTERM); // the pipe has only this one in it
        QTRY_COMPARE(received.size(), 1);
    }
};
