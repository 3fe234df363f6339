#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace hermes {

/// How far long work has come, and how long the rest takes at this pace, on stderr. On a terminal it is one
/// line, which is written again ten times a second and removed when the work is done. After useJson() it is a
/// JSON object a line, at most twice a second and once more when the work is done, terminal or not. Else it
/// is nothing. In the first second of a program nothing is told.
class Progress {
public:
    /// what: the work and what is counted, without characters that JSON escapes: "tracking, scan".
    explicit Progress(std::string what);
    ~Progress();
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    /// As often as you like: what is not shown costs a look at the clock. total: 0 when it is not known. The
    /// pace is that since the first call.
    void update(double done, double total);
    /// What follows is called so; the time goes on.
    void rename(std::string what) { what_ = std::move(what); }

    /// Of all that begin from now on.
    static void useJson();
    static bool isJson() { return areJson; }

private:
    enum class Form { None, Line, Json };
    static bool areJson;
    static std::chrono::steady_clock::time_point next; ///< when it is told again

    void writeObject(double done, std::optional<double> all, double spent, std::optional<double> left) const;
    void writeLine(double done, std::optional<double> all, std::optional<double> left) const;
    void removeLine();

    std::string what_;
    const Form form_;
    bool isShown_ = false, isDone_ = false;
    struct Mark {
        double done;
        std::chrono::steady_clock::time_point when;
    };
    std::optional<Mark> first_;
    std::chrono::steady_clock::time_point begin_;
};

} // namespace hermes
