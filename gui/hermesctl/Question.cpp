#include "gui/hermesctl/Question.h"

#include "common/platform/Console.h"
#include "gui/hermesctl/Output.h"

#include <iostream>
#include <string>

namespace hermes::ctl {

bool canAsk() {
    return isTerminal(StandardStream::Input) && isTerminal(StandardStream::Errors);
}

QString answerTo(const QString &question) {
    printError(question + ' ');
    std::string line;
    if (!std::getline(std::cin, line))
        return "q";
    return QString::fromStdString(line).trimmed().toLower();
}

bool isConfirmed(const QString &question) {
    const QString answer = answerTo(question + " [y/N]");
    return answer == "y" || answer == "yes";
}

} // namespace hermes::ctl
