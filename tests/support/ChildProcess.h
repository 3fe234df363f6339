#pragma once

#include <QProcess>

#include <csignal>
#include <sys/prctl.h>

/// A program that ends with this one, however that ends: it must not go on and disturb other tests.
class ChildProcess : public QProcess {
protected:
    void setupChildProcess() override { ::prctl(PR_SET_PDEATHSIG, SIGKILL); }
};
