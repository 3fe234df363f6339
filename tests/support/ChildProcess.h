#pragma once

#include <QProcess>

#include <csignal>
#include <sys/prctl.h>
#include <sys/resource.h>

/// A program that ends with this one, however that ends: it must not go on and disturb other tests.
class ChildProcess : public QProcess {
public:
    /// Once it is started: it goes before other programs, where that is permitted, in a test that is not of
    /// what a busy machine does to it.
    void goBeforeOthers() { ::setpriority(PRIO_PROCESS, id_t(processId()), -15); }

protected:
    void setupChildProcess() override { ::prctl(PR_SET_PDEATHSIG, SIGKILL); }
};
