// Calls over TCP and TLS on loopback, pipelined by 1, 8 and 200 clients and one after the other, beside a
// bare Qt server with QJsonDocument. Servers are processes of their own.
#include "common/Log.h"
#include "common/daemon/Daemon.h"
#include "common/tls/Authority.h"

#include <QCoreApplication>
#include <QHostAddress>
#include <QJsonDocument>
#include <QTcpServer>
#include <QTcpSocket>
#include <QTemporaryDir>
#include <QUrl>
#include <algorithm>
#include <benchmark/benchmark.h>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace hermes;
using Clock = std::chrono::steady_clock;

constexpr int window = 100; // calls that a client has under way

class CheapDaemon : public Daemon {
public:
    CheapDaemon()
        : Daemon({"bench", "Bench", "Answers", 1}) {
        addCommand(
            Command("nothing", "Does nothing").needs(Role::Observer).returnsNull().handler([](const Call &) {
                return QJsonValue();
            }));
    }
};

/// What a program with QTcpServer and QJsonDocument does with the same lines, without any checks.
class BareServer : public QTcpServer {
public:
    BareServer() {
        connect(this, &QTcpServer::newConnection, this, [this] {
            QTcpSocket *const peer = nextPendingConnection();
            peer->setSocketOption(QAbstractSocket::LowDelayOption, 1);
            connect(peer, &QTcpSocket::readyRead, peer, [peer] {
                while (peer->canReadLine()) {
                    const QJsonObject request = QJsonDocument::fromJson(peer->readLine()).object();
                    const QJsonObject reply{
                        {"jsonrpc", "2.0"}, {"id", request["id"]}, {"result", QJsonValue()}};
                    peer->write(QJsonDocument(reply).toJson(QJsonDocument::Compact) + '\n');
                }
            });
        });
    }
};

quint16 serveDaemon(const QString &url) {
    Log::instance().setStderr(false);
    auto *const daemon = new CheapDaemon;
    if (daemon->prepare({"bench", "--listen", url, "--set", "limits.clients=1000"}) || !daemon->launch())
        return 0;
    return quint16(QUrl(daemon->server().addresses().value(0)).port());
}

quint16 serveBare() {
    auto *const server = new BareServer;
    return server->listen(QHostAddress(QHostAddress::LocalHost)) ? server->serverPort() : 0;
}

/// Begins a server in a process that ends with this one; gives its port.
quint16 started(const std::function<quint16()> &serve) {
    int ends[2];
    if (::pipe(ends) != 0)
        return 0;
    if (::fork() == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        int argc = 0;
        QCoreApplication application(argc, nullptr);
        const quint16 port = serve();
        if (::write(ends[1], &port, sizeof port) != sizeof port)
            ::_exit(1);
        ::_exit(QCoreApplication::exec());
    }
    quint16 port = 0;
    if (::read(ends[0], &port, sizeof port) != sizeof port)
        port = 0;
    ::close(ends[0]);
    ::close(ends[1]);
    return port;
}

/// Keys of a daemon and of a client.
class Keys {
public:
    Keys() {
        const Authority authority(folder_.filePath("keys"));
        if (!authority.init("bench", 1, 1) || !authority.issue({"robot", "daemon"}, 1))
            return;
        ::rename(qPrintable(folder_.filePath("keys/issued-for/robot")), qPrintable(robot()));
        const QByteArray own = folder_.filePath("keys/own").toUtf8();
        context_.reset(SSL_CTX_new(TLS_client_method()));
        isFine_ = SSL_CTX_use_certificate_file(context_.get(), own + ".crt", SSL_FILETYPE_PEM) == 1 &&
                  SSL_CTX_use_PrivateKey_file(context_.get(), own + ".key", SSL_FILETYPE_PEM) == 1;
    }
    QString robot() const { return folder_.filePath("robot"); }
    SSL_CTX *context() const { return isFine_ ? context_.get() : nullptr; }

private:
    QTemporaryDir folder_;
    std::unique_ptr<SSL_CTX, void (*)(SSL_CTX *)> context_{nullptr, SSL_CTX_free};
    bool isFine_ = false;
};

/// A client that waits for its answers.
class Caller {
public:
    /// Over TLS with a context.
    explicit Caller(quint16 port, SSL_CTX *context = nullptr)
        : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int on = 1;
        ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0;
        if (!context || !connected_)
            return;
        ssl_.reset(SSL_new(context));
        connected_ = SSL_set_fd(ssl_.get(), socket_) == 1 && SSL_connect(ssl_.get()) == 1;
    }
    Caller(const Caller &) = delete;
    ~Caller() { ::close(socket_); }

    bool send(const QByteArray &bytes) {
        return connected_ && (ssl_ ? SSL_write(ssl_.get(), bytes.constData(), bytes.size())
                                   : ::send(socket_, bytes.constData(), size_t(bytes.size()),
                                            MSG_NOSIGNAL)) == bytes.size();
    }
    /// So many lines.
    bool receive(int lines) {
        char buffer[65536];
        while (lines > 0) {
            const ssize_t size = ssl_ ? SSL_read(ssl_.get(), buffer, sizeof buffer)
                                      : ::recv(socket_, buffer, sizeof buffer, 0);
            if (size <= 0)
                return false;
            lines -= int(std::count(buffer, buffer + size, '\n'));
        }
        return lines == 0;
    }

private:
    const int socket_;
    std::unique_ptr<SSL, void (*)(SSL *)> ssl_{nullptr, SSL_free};
    bool connected_ = false;
};

QByteArray requests(const char *method, int count) {
    QByteArray lines;
    for (int i = 0; i < count; ++i)
        lines += R"({"jsonrpc":"2.0","id":)" + QByteArray::number(i) + R"(,"method":")" + method + "\"}\n";
    return lines;
}

void pipelined(benchmark::State &state, quint16 port, const char *method, SSL_CTX *context) {
    std::vector<std::unique_ptr<Caller>> callers;
    for (int i = 0; i < state.range(0); ++i)
        callers.push_back(std::make_unique<Caller>(port, context));
    const QByteArray lines = requests(method, window);
    const auto begin = Clock::now();
    double calls = 0;
    for (auto _ : state) {
        bool isFine = true;
        for (const auto &caller : callers)
            isFine = caller->send(lines) && isFine;
        for (const auto &caller : callers)
            isFine = isFine && caller->receive(window);
        if (!isFine)
            return state.SkipWithError("the server does not answer");
        calls += double(window) * double(callers.size());
    }
    state.counters["calls_per_s"] = calls / std::chrono::duration<double>(Clock::now() - begin).count();
}

void roundTrips(benchmark::State &state, quint16 port, SSL_CTX *context) {
    Caller caller(port, context);
    const QByteArray line = requests("nothing", 1);
    std::vector<double> taken_us;
    for (auto _ : state) {
        const auto begin = Clock::now();
        if (!caller.send(line) || !caller.receive(1))
            return state.SkipWithError("the server does not answer");
        taken_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    }
    const auto middle = taken_us.begin() + std::ptrdiff_t(taken_us.size() / 2);
    std::nth_element(taken_us.begin(), middle, taken_us.end());
    state.counters["median_us"] = *middle;
}

} // namespace

int main(int argc, char **argv) {
    const Keys keys;
    const quint16 daemon = started([] { return serveDaemon("tcp://127.0.0.1:0"); }),
                  guarded =
                      started([&keys] { return serveDaemon("tls://127.0.0.1:0?keys=" + keys.robot()); }),
                  bare = started(serveBare);
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    const auto add = [](const char *name, quint16 port, const char *method, SSL_CTX *context = nullptr) {
        benchmark::RegisterBenchmark(name, pipelined, port, method, context)
            ->Arg(1)
            ->Arg(8)
            ->Arg(200)
            ->UseRealTime();
    };
    add("cheap calls", daemon, "nothing");
    add("cheap calls, TLS", guarded, "nothing", keys.context());
    add("daemon.info", daemon, "daemon.info");
    add("cheap calls, bare Qt server", bare, "nothing");
    benchmark::RegisterBenchmark("round trip", roundTrips, daemon, nullptr)->UseRealTime();
    benchmark::RegisterBenchmark("round trip, TLS", roundTrips, guarded, keys.context())->UseRealTime();
    benchmark::RegisterBenchmark("round trip, bare Qt server", roundTrips, bare, nullptr)->UseRealTime();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
