#include "common/platform/TemporaryNames.h"

#include <climits>
#include <csignal>
#include <cstring>
#include <unistd.h>

namespace hermes {

namespace {

// Where a signal handler can read them.
constexpr std::size_t maxNames = 32;
char temporaries[maxNames][PATH_MAX];

void removeAndDie(int signal) {
    for (std::size_t i = maxNames; i-- > 0;)
        if (temporaries[i][0] != '\0' && ::unlink(temporaries[i]) != 0)
            ::rmdir(temporaries[i]);
    std::signal(signal, SIG_DFL);
    ::raise(signal);
}

} // namespace

/// maxNames when the list is full or the name is too long.
std::size_t rememberTemporary(const std::string &name) {
    std::size_t place = 0;
    while (place < maxNames && temporaries[place][0] != '\0')
        ++place;
    if (place == maxNames || name.size() >= PATH_MAX)
        return maxNames;
    std::strcpy(temporaries[place], name.c_str());
    return place;
}

void forgetTemporary(std::size_t place) {
    if (place < maxNames)
        temporaries[place][0] = '\0';
}

void removeTemporariesOnSignals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        std::signal(signal, removeAndDie);
}

} // namespace hermes
