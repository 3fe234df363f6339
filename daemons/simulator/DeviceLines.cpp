#include "daemons/simulator/DeviceLines.h"
#include "common/Time.h"

#include <QTimer>

#include <cmath>

namespace hermes::simulator {

namespace {

constexpr int refusal_ms = 100;

void garble(QByteArray &bytes, std::minstd_rand &random) {
    for (char &byte : bytes)
        byte = char(random() >> 8);
}

} // namespace

Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link) {
    InterfaceUrl url;
    url.scheme = "pty";
    url.path = link;
    auto pty = std::make_shared<PtyInterface>(url, nullptr);
    QString failure;
    const auto watch = QObject::connect(pty.get(), &Interface::closed, pty.get(),
                                        [&failure](const QString &why) { failure = why; });
    pty->open();
    QObject::disconnect(watch);
    if (!pty->isOpen())
        return Error(ErrorCode::InputOutput, failure);
    return pty;
}

Result<void> SensorLine::open(const QString &link, int baud, double patience_s, const Receiver &received) {
    auto opened = openDeviceLine(link);
    if (!opened)
        return opened.error();
    pty_ = *opened;
    pty_->setBaud(baud);
    QObject::connect(pty_.get(), &Interface::received, [this, received](const QByteArray &bytes) {
        if (!isGarbled())
            received(bytes);
    });
    state_.line.link = link;
    baud_ = baud;
    patience_s_ = patience_s;
    return {};
}

Result<void> SensorLine::listen(std::uint16_t port, const Receiver &received) {
    InterfaceUrl url;
    url.scheme = "tcp";
    url.host = "127.0.0.1";
    url.port = port;
    server_ = std::make_unique<TcpServerInterface>(url, nullptr);
    QObject::connect(server_.get(), &Listener::accepted, [this, received](Interface *program) {
        if (!program_)
            return take(program, received);
        program->setReceiving(false);
        // The other one may have gone, which is not seen yet.
        QTimer::singleShot(refusal_ms, program, [this, program, received] {
            if (program_ || pulled_ || !program->isOpen())
                program->deleteLater();
            else
                take(program, received);
        });
    });
    return server_->listen();
}

void SensorLine::take(Interface *program, const Receiver &received) {
    program_ = program;
    program->setWriteLimit(maxUnsent);
    program->setReceiving(true);
    QObject::connect(program, &Interface::received, received);
    QObject::connect(program, &Interface::closed, [this, program, received] {
        program->deleteLater();
        program_.clear();
        received({});
    });
}

void SensorLine::send(QByteArray bytes) {
    if (program_)
        (program_->write(bytes) ? state_.bytes : state_.unreadLost) += bytes.size();
    if (!pty_ || !pty_->isOpen())
        return;
    const qint64 unread = pty_->unread(); // of which the system does not tell more than some thousand
    const double now = monotonicNow();
    const bool tooLate = unread > maxUnread && now - behindSince_ > patience_s_;
    if (tooLate)
        state_.unreadLost += std::max(behind_, pty_->discardUnread());
    if (tooLate || unread <= maxUnread) {
        behindSince_ = now;
        behind_ = tooLate ? 0 : unread;
    }
    if (isGarbled())
        garble(bytes, garbage_);
    const bool taken = pty_->write(bytes);
    (taken ? state_.bytes : state_.unreadLost) += bytes.size();
    behind_ += taken ? bytes.size() : 0;
}

void SensorLine::setPulled(bool pulled) {
    if (server_ && pulled != pulled_) {
        server_->close();
        if (program_)
            program_->close();
        pulled_ = pulled || !server_->listen();
    }
    if (server_)
        return;
    if (pulled)
        return pty_->close();
    if (pty_->isOpen())
        return;
    pty_->open();
    pty_->setBaud(baud_);
}

const SensorLineState &SensorLine::state() {
    if (server_)
        state_.line.device = pulled_ ? QString() : server_->address();
    else
        state_.line.device = pty_ ? pty_->device() : QString();
    return state_;
}

Result<void> MotorLines::open(const QStringList &links, int baud) {
    close();
    baud_ = baud;
    for (const QString &link : links) {
        const auto opened = openDeviceLine(link);
        if (!opened) {
            close();
            return opened.error();
        }
        (*opened)->setBaud(baud);
        const int number = count();
        connect(opened->get(), &Interface::received, this,
                [this, number](const QByteArray &bytes) { receive(number, bytes); });
        lines_.push_back({link, *opened});
    }
    return {};
}

void MotorLines::close() {
    lines_.clear();
}

void MotorLines::setPulled(int line, bool pulled) {
    PtyInterface &pty = *lines_[std::size_t(line)].pty;
    if (pulled)
        return pty.close();
    if (pty.isOpen())
        return;
    pty.open();
    pty.setBaud(baud_);
}

std::vector<LineState> MotorLines::state() const {
    std::vector<LineState> lines;
    for (const Line &line : lines_)
        lines.push_back({line.link, line.pty->device()});
    return lines;
}

void MotorLines::receive(int line, const QByteArray &bytes) {
    PtyInterface *pty = lines_[std::size_t(line)].pty.get();
    const auto carried = [this, pty](QByteArray moved) {
        if (baud_ > 0 && pty->baud() != baud_)
            garble(moved, garbage_);
        return moved;
    };
    for (const MotorEmulator::Answer &answer : device_(line, carried(bytes), monotonicNow())) {
        const QByteArray out = carried(
            QByteArray(reinterpret_cast<const char *>(answer.bytes.data()), int(answer.bytes.size())));
        if (answer.delay > 0)
            QTimer::singleShot(int(std::ceil(answer.delay * 1000)), Qt::PreciseTimer, pty,
                               [pty, out] { pty->write(out); });
        else
            pty->write(out);
    }
}

} // namespace hermes::simulator
