#include "daemons/simulator/MotorLines.h"

#include "common/Time.h"

#include <QTimer>
#include <cmath>

namespace hermes::simulator {

Result<void> MotorLines::open(const QStringList &links) {
    close();
    for (const QString &link : links) {
        const auto opened = openDeviceLine(link);
        if (!opened) {
            close();
            return opened.error();
        }
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
    if (pulled)
        lines_[std::size_t(line)].pty->close();
    else
        lines_[std::size_t(line)].pty->open();
}

std::vector<LineState> MotorLines::state() const {
    std::vector<LineState> lines;
    for (const Line &line : lines_)
        lines.push_back({line.link, line.pty->device()});
    return lines;
}

void MotorLines::receive(int line, const QByteArray &bytes) {
    PtyInterface *pty = lines_[std::size_t(line)].pty.get();
    for (const RoboClawEmulator::Answer &answer : device_(line, bytes, monotonicNow())) {
        const QByteArray out(reinterpret_cast<const char *>(answer.bytes.data()), int(answer.bytes.size()));
        if (answer.delay > 0)
            QTimer::singleShot(int(std::ceil(answer.delay * 1000)), Qt::PreciseTimer, pty,
                               [pty, out] { pty->write(out); });
        else
            pty->write(out);
    }
}

} // namespace hermes::simulator
