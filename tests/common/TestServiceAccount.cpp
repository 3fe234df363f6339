#include "common/ServiceAccount.h"

#include <grp.h>
#include <pwd.h>

using namespace hermes;

/// Who stands for a service: the members of its group, and never that of root or of a person.
class TestServiceAccount : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void knowsItsMembers_data() {
        const Rows<uint, uint, bool> row("account", "user", "isMember");
        const uint daemon = 1, bin = 2, nobody = 65534, none = 4000000000u,
                   person = 1000; // of Debian's base-passwd
        row("itself", daemon, daemon, true);
        row("another service", daemon, bin, false);
        row("nobody", daemon, nobody, false);
        row("root's group is none", 0u, 0u, false);
        row("a person's group is none", person, person, false);
        row("nobody is no service", nobody, nobody, false);
        row("unknown user", daemon, none, false);
        row("unknown account", 998u, none, false);
    }
    void knowsItsMembers() {
        FETCH(uint, account, uint, user, bool, isMember);
        if (isMember && !::getpwuid(account))
            QSKIP("this system has no user 1, which Debian has");
        QCOMPARE(ServiceAccount::hasMember(account, user), isMember);
    }

    /// Whoever is told in the list of members, whatever the own group is.
    void knowsThoseInTheList() {
        int found = 0;
        ::setgrent();
        while (const group *const entry = ::getgrent()) {
            const passwd *const account = ::getpwnam(entry->gr_name);
            if (!account || account->pw_uid == 0 || account->pw_uid > 999 || account->pw_gid != entry->gr_gid)
                continue;
            const uid_t service = account->pw_uid;
            for (char **name = entry->gr_mem; *name; ++name)
                if (const passwd *const member = ::getpwnam(*name)) {
                    QVERIFY2(ServiceAccount::hasMember(service, member->pw_uid), *name);
                    ++found;
                }
        }
        ::endgrent();
        if (found == 0)
            QSKIP("no service of this system has further members (deploy/test-install makes one)");
    }
};
