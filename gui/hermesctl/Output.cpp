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
    QString name = "stdout";
    bool overwrites = false;
    bool isGone = false;
    bool jsonNotes = false;
};
Destination destination;

/// why: otherwise what the system says.
[[noreturn]] void failToWrite(const QString &why = {}) {
    const QString text =
        QString("%1 cannot be written: %2")
            .arg(destination.name, why.isEmpty() ? QString::fromUtf8(std::strerror(errno)) : why);
    const QJsonObject object{{"code", int(ErrorCode::InputOutput)}, {"message", text}};
    printError((destination.jsonNotes ? QString::fromUtf8(compactJson(object)) : "hermesctl: " + text) +
               '\n');
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
        return Error(
            ErrorCode::InputOutput,
            QString("--out %1: the file exists; --force overwrites it, or take another name").arg(file),
            QJsonObject{{"path", file}});
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
    std::fputs((printable(text, false) + '\n').toUtf8().constData(), opened());
    checkOutput();
}

void printJson(const QJsonValue &value) {
    printLine(QString::fromUtf8(compactJson(value)));
}

void printTable(const std::vector<QStringList> &rows) {
    std::vector<int> widths;
    for (const QStringList &row : rows) {
        widths.resize(std::max(widths.size(), std::size_t(row.size())));
        for (int i = 0; i < row.size(); ++i)
            widths[std::size_t(i)] = std::max(widths[std::size_t(i)], row[i].size());
    }
    for (const QStringList &row : rows) {
        QString line;
        for (int i = 0; i < row.size(); ++i)
            line += row[i].leftJustified(widths[std::size_t(i)] + 2);
        printLine(line.trimmed());
    }
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

QString printable(const QString &text, bool isOneLine) {
    QString result;
    result.reserve(text.size());
    for (const QChar c : text) {
        const bool isLayout = !isOneLine && (c == '\n' || c == '\t');
        const bool isCommand = c.category() == QChar::Other_Control || c.category() == QChar::Other_Format ||
                               c == QChar::LineSeparator || c == QChar::ParagraphSeparator;
        if (isCommand && !isLayout)
            result += QString("\\u%1").arg(c.unicode(), 4, 16, QChar('0'));
        else
            result += c;
    }
    return result;
}

void printError(const QString &text) {
    std::fputs(printable(text, false).toLocal8Bit().constData(), stderr);
}

void note(const QString &text) {
    printError((destination.jsonNotes ? QString::fromUtf8(compactJson(QJsonObject{{"note", text}}))
                                      : "hermesctl: " + text) +
               '\n');
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
