#include "gui/hermesctl/Output.h"

#include "common/daemon/SignalWatcher.h"
#include "protocol/wire/JsonText.h"

#include <QFile>
#include <QJsonObject>
#include <QTimer>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace hermes::ctl {
namespace {

struct Destination {
    FILE *file = stdout;
    QString name = QStringLiteral("stdout");
    bool isGone = false;
    bool jsonNotes = false;
};
Destination destination;

} // namespace

Result<void> openOutput(const QString &file, bool force) {
    const int mode = O_WRONLY | O_CREAT | O_CLOEXEC | (force ? O_TRUNC : O_EXCL);
    const int descriptor = ::open(QFile::encodeName(file).constData(), mode, 0666);
    if (descriptor < 0 && errno == EEXIST)
        return Error(ErrorCode::InputOutput,
                     QStringLiteral("--out %1: the file exists; --force overwrites it, or take another name")
                         .arg(file),
                     QJsonObject{{QStringLiteral("path"), file}});
    if (descriptor < 0)
        return Error(ErrorCode::InputOutput,
                     QStringLiteral("--out %1: cannot be written: %2")
                         .arg(file, QString::fromUtf8(std::strerror(errno))),
                     QJsonObject{{QStringLiteral("path"), file}});
    destination.file = ::fdopen(descriptor, "w");
    destination.name = file;
    return {};
}

void checkOutput() {
    if (destination.isGone || (std::fflush(destination.file) == 0 && std::ferror(destination.file) == 0))
        return;
    if (errno == EPIPE) {
        destination.isGone = true;
        return;
    }
    std::fprintf(stderr, "hermesctl: %s cannot be written: %s\n", qPrintable(destination.name),
                 std::strerror(errno));
    std::_Exit(1);
}

void printLine(const QString &text) {
    if (destination.isGone)
        return;
    std::fputs((text + QLatin1Char('\n')).toUtf8().constData(), destination.file);
    checkOutput();
}

void printJson(const QJsonValue &value) {
    printLine(QString::fromUtf8(compactJson(value)));
}

bool readerIsGone() {
    pollfd end{::fileno(destination.file), 0, 0}; // a pipe that nobody reads, also where nothing was written
    if (::poll(&end, 1, 0) > 0 && (end.revents & POLLERR) != 0)
        destination.isGone = true;
    return destination.isGone;
}

void setJsonNotes(bool on) {
    destination.jsonNotes = on;
}

void note(const QString &text) {
    if (destination.jsonNotes)
        std::fprintf(stderr, "%s\n", compactJson(QJsonObject{{QStringLiteral("note"), text}}).constData());
    else
        std::fprintf(stderr, "hermesctl: %s\n", qPrintable(text));
}

void runStream(QEventLoop &loop) {
    SignalWatcher signals(nullptr);
    QObject::connect(&signals, &SignalWatcher::received, &loop, &QEventLoop::quit);
    QTimer look;
    QObject::connect(&look, &QTimer::timeout, &loop, [&loop] {
        if (readerIsGone())
            loop.quit();
    });
    look.start(200);
    loop.exec();
}

} // namespace hermes::ctl
