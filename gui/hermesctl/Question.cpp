#include "gui/hermesctl/Question.h"

#include <cstdio>
#include <iostream>
#include <string>
#include <unistd.h>

namespace hermes::ctl {

bool canAsk() {
    return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0;
}

QString answerTo(const QString &question) {
    std::fprintf(stderr, "%s ", qPrintable(question));
    std::string line;
    if (!std::getline(std::cin, line))
        return QStringLiteral("q");
    return QString::fromStdString(line).trimmed().toLower();
}

bool isConfirmed(const QString &question) {
    const QString answer = answerTo(question + " [y/N]");
    return answer == "y" || answer == "yes";
}

} // namespace hermes::ctl
