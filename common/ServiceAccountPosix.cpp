#include "common/ServiceAccount.h"

#include <algorithm>
#include <grp.h>
#include <optional>
#include <pwd.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace hermes {
namespace {

struct Account {
    std::string name;
    gid_t group = 0;
};

std::optional<Account> accountOf(uid_t user) {
    std::vector<char> text(16384);
    passwd entry{};
    passwd *found = nullptr;
    if (::getpwuid_r(user, &entry, text.data(), text.size(), &found) != 0 || !found)
        return std::nullopt;
    return Account{found->pw_name, found->pw_gid};
}

std::vector<gid_t> groupsOf(const Account &account) {
    std::vector<gid_t> groups(64);
    int count = int(groups.size());
    while (::getgrouplist(account.name.c_str(), account.group, groups.data(), &count) < 0 &&
           count > int(groups.size()))
        groups.resize(size_t(count));
    groups.resize(size_t(std::max(0, count)));
    return groups;
}

} // namespace

QString ServiceAccount::nameOf(unsigned user) {
    const auto account = accountOf(user);
    return account ? QString::fromStdString(account->name) : QString::number(user);
}

bool ServiceAccount::hasMember(unsigned account, unsigned user) {
    constexpr uid_t lastOfSystem = 999; // Debian policy 9.2.2
    if (account == 0 || account > lastOfSystem)
        return false;
    const auto service = accountOf(account), member = accountOf(user);
    if (!service || !member || service->group == 0)
        return false;
    const std::vector<gid_t> groups = groupsOf(*member);
    return std::find(groups.begin(), groups.end(), service->group) != groups.end();
}

bool ServiceAccount::standsForThisProgram(unsigned user) {
    return user == 0 || user == ::geteuid() || hasMember(::geteuid(), user);
}

} // namespace hermes
