#include "gui/hermesctl/Output.h"

#include "common/daemon/SignalWatcher.h"
#include "common/platform/Pipes.h"
#include "protocol/wire/JsonText.h"

#include <QFile>
#include <QJsonObject>
#include <QTimer>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace hermes::ctl {
namespace {

struct Destination {
    FILE *file = stdout; // nullptr: not made yet
    QString name = QStringLiteral("stdout");
    bool overwrites = false;
    bool isGone = false;
    bool jsonNotes = false;
};
Destination destination;

/// why: otherwise what the system says.
[[noreturn]] void failToWrite(const QString &why = {}) {
    const QString text =
        QStringLiteral("%1 cannot be written: %2")
            .arg(destination.name, why.isEmpty() ? QString::fromUtf8(std::strerror(errno)) : why);
    if (destination.jsonNotes)
        std::fprintf(stderr, "%s\n",
                     compactJson(QJsonObject{{QStringLiteral("code"), int(ErrorCode::InputOutput)},
                                             {QStringLiteral("message"), text}})
                         .constData());
    else
        std::fprintf(stderr, "hermesctl: %s\n", qPrintable(text));
    std::_Exit(1);
}

/// A file is made with the first line for it: where nothing can be said, none is left behind.
FILE *opened() {
    if (destination.file)
        return destination.file;
    const auto how = destination.overwrites ? QIODevice::Truncate : QIODevice::NewOnly;
    static auto *const made = new QFile(destination.name); // open as long as the program runs
    const bool isMade = made->open(QIODevice::WriteOnly | how);
    destination.file = isMade ? streamInto(made->handle()) : nullptr;
    if (!destination.file)
        failToWrite(isMade ? QString() : made->errorString());
    return destination.file;
}

} // namespace

Result<void> setOutput(const QString &file, bool force) {
    if (!force && QFile::exists(file))
        return Error(ErrorCode::InputOutput,
                     QStringLiteral("--out %1: the file exists; --force overwrites it, or take another name")
                         .arg(file),
                     QJsonObject{{QStringLiteral("path"), file}});
    destination.file = nullptr;
    destination.name = file;
    destination.overwrites = force;
    return {};
}

void checkOutput() {
    FILE *const file = destination.file;
    if (!file || destination.isGone || (std::fflush(file) == 0 && std::ferror(file) == 0))
        return;
    if (errno != EPIPE)
        failToWrite();
    destination.isGone = true;
}

void printLine(const QString &text) {
    if (destination.isGone)
        return;
    std::fputs((text + QLatin1Char('\n')).toUtf8().constData(), opened());
    checkOutput();
}

void printJson(const QJsonValue &value) {
    printLine(QString::fromUtf8(compactJson(value)));
}

bool readerIsGone() {
    if (!destination.file)
        return false;
    if (isOtherEndGone(destination.file))
        destination.isGone = true;
    return destination.isGone;
}

void setJsonNotes(bool on) {
    destination.jsonNotes = on;
}

QString printable(QString text) {
    for (QChar &c : text)
        if (!c.isPrint())
            c = QLatin1Char('?');
    return text;
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
