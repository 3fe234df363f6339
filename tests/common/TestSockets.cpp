// Waiting for sockets while signals come.
#include "common/platform/Sockets.h"

#include <sys/socket.h>
#include <sys/time.h>

using namespace hermes;

class TestSockets : public QObject {
    Q_OBJECT

    static inline volatile std::sig_atomic_t writeTo = -1;
    static inline volatile std::sig_atomic_t signalsLeft = 0; // before the handler writes

    static void handle(int) {
        signalsLeft = signalsLeft - 1;
        if (signalsLeft == 0 && ::write(writeTo, "x", 1) < 0)
            ::abort();
    }

    /// A signal every 20 ms.
    class Signals {
    public:
        Signals() {
            struct sigaction action {};
            action.sa_handler = handle; // without SA_RESTART
            ::sigaction(SIGALRM, &action, nullptr);
            set(20000);
        }
        ~Signals() { set(0); }

    private:
        static void set(suseconds_t period_us) {
            const itimerval timer{{0, period_us}, {0, period_us}};
            ::setitimer(ITIMER_REAL, &timer, nullptr);
        }
    };

private Q_SLOTS:
    void init() {
        int ends[2];
        QCOMPARE(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
        all_ = {{ends[0]}};
        writeTo = ends[1];
        signalsLeft = 0;
    }
    void cleanup() {
        sockets::close(all_[0].socket);
        sockets::close(writeTo);
    }

    void signalsDoNotShortenWaiting() {
        const Signals signals;
        auto timer = runningTimer();
        QVERIFY(!sockets::waitFor(all_, 200));
        QVERIFY2(timer.elapsed() >= 200, saying(timer.elapsed()));
        QVERIFY(!all_[0].isReady);
    }

    void whatComesAfterSignalsIsSeen_data() {
        const Rows<int> row("most_ms");
        row("in time", 60000);
        row("without a limit", -1);
    }
    void whatComesAfterSignalsIsSeen() {
        QFETCH(int, most_ms);
        signalsLeft = 3;
        const Signals signals;
        QVERIFY(sockets::waitFor(all_, most_ms));
        QVERIFY(all_[0].isReady);
    }

private:
    std::vector<sockets::Awaited> all_;
};
