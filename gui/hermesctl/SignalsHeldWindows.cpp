#include "gui/hermesctl/SignalsHeld.h"

#include <atomic>
#include <windows.h>

namespace hermes::ctl {
namespace {

std::atomic<bool> cameMeanwhile{false};

/// Of Ctrl-C and Ctrl-Break; when the console is closed Windows waits no longer than it wants to.
BOOL WINAPI note(DWORD event) {
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT)
        return FALSE;
    cameMeanwhile = true;
    return TRUE;
}

} // namespace

struct SignalsHeld::State {};

SignalsHeld::SignalsHeld() {
    ::SetConsoleCtrlHandler(note, TRUE);
}

SignalsHeld::~SignalsHeld() {
    ::SetConsoleCtrlHandler(note, FALSE);
    if (cameMeanwhile)
        ::ExitProcess(DWORD(STATUS_CONTROL_C_EXIT));
}

} // namespace hermes::ctl
