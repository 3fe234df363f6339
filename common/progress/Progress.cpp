#include "common/progress/Progress.h"

#include "common/platform/Console.h"
#include "common/platform/Pipes.h"

#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace hermes {

namespace {

using namespace std::chrono_literals;

constexpr auto silent = 1s;
constexpr auto betweenLines = 100ms, betweenObjects = 500ms;

// Not of printf(), which writes a decimal comma where the locale has one.
std::string decimals(double value, int count) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(count) << value;
    return text.str();
}

/// A whole number as it is.
std::string number(double value) {
    return decimals(value, std::floor(value) == value ? 0 : 1);
}

std::string numberOrNull(std::optional<double> value) {
    return value ? number(*value) : "null";
}

double seconds(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

void write(const std::string &text) {
    if (!takesMore(stderr)) // where nobody reads it the work goes on
        return;
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

} // namespace

bool Progress::areJson = false;
std::chrono::steady_clock::time_point Progress::next = std::chrono::steady_clock::now() + silent;

void Progress::useJson() {
    areJson = true;
}

Progress::Progress(std::string what)
    : what_(std::move(what))
    , form_(areJson                              ? Form::Json
            : isTerminal(StandardStream::Errors) ? Form::Line
                                                 : Form::None)
    , begin_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
    removeLine();
}

void Progress::removeLine() {
    if (isShown_ && form_ == Form::Line)
        write("\r\033[K");
    isShown_ = false;
}

void Progress::update(double done, double total) {
    if (form_ == Form::None || isDone_)
        return;
    const bool isKnown = total > 0 && done <= total;
    isDone_ = isKnown && done >= total;
    const auto now = std::chrono::steady_clock::now();
    if (!first_)
        first_ = {done, now};
    if (isDone_ ? !isShown_ : now < next)
        return;
    if (isDone_ && form_ == Form::Line)
        return removeLine();
    isShown_ = true;
    std::optional<double> all, left;
    if (isKnown)
        all = total;
    if (isKnown && done > first_->done)
        left = seconds(now - first_->when) * (total - done) / (done - first_->done);
    form_ == Form::Json ? writeObject(done, all, seconds(now - begin_), left) : writeLine(done, all, left);
    next = now + (form_ == Form::Json ? betweenObjects : betweenLines);
}

void Progress::writeObject(double done, std::optional<double> all, double spent,
                           std::optional<double> left) const {
    write(R"({"progress":{"what":")" + what_ + R"(","done":)" + number(done) + R"(,"total":)" +
          numberOrNull(all) + R"(,"elapsed_s":)" + number(spent) + R"(,"left_s":)" + numberOrNull(left) +
          "}}\n");
}

void Progress::writeLine(double done, std::optional<double> all, std::optional<double> left) const {
    std::string text = what_ + ' ' + decimals(std::floor(done), 0);
    if (all)
        text += " of " + decimals(*all, 0) + " (" + decimals(std::floor(100 * done / *all), 0) + " %)";
    if (left)
        text += ", " + decimals(std::ceil(*left), 0) + " s left";
    write("\r\033[K" + text);
}

} // namespace hermes
