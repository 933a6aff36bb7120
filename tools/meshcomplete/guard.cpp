#include "tools/meshcomplete/guard.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#include "tools/meshcomplete/errors.h"

namespace meshcomplete {
namespace runner {
namespace guard {

namespace {

/// The signal that a crashed thread sends to the guard's thread.
constexpr int crash_notice = SIGUSR1;
constexpr int crash_signals[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
/// A crashed thread may hold a lock that writing the report needs; after this many seconds the program ends
/// without.
constexpr unsigned crash_patience = 5;

/// Lives until the process ends: the guard's thread is never joined.
struct State {
  std::mutex mutex;
  Reaction reaction = Reaction::end_at_once;
  Ending ending;
  std::string activity = "starting";
  std::atomic<bool> cancelled{false};
  std::atomic<int> crash_signal{0};
  pthread_t thread{};
  char alternate_stack[1 << 16];
};

State& state() {
  static State* const the_state = new State;
  return *the_state;
}

void write_text(const char* text) {
  const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);
}

[[noreturn]] void end(int exit_code, const std::string& message) {
  if (isatty(STDERR_FILENO) == 1) write_text("\r\033[K");
  write_text(("meshcomplete: " + message + "\n").c_str());
  if (state().ending) state().ending(exit_code, QString::fromStdString(message));
  _exit(exit_code);
}

[[noreturn]] void end_after_crash() {
  const char* name = strsignal(state().crash_signal);
  end(exit_failed,
      std::string("Something crashed while ") + state().activity + " (" + name +
          "). Nothing was written. The mesh may be damaged, or have faces with a repeated corner.");
}

void handle_interrupt() {
  const std::lock_guard<std::mutex> lock(state().mutex);
  if (state().reaction == Reaction::finish) return;
  if (state().reaction == Reaction::end_at_once || state().cancelled)
    end(exit_cancelled, "Cancelled. Nothing was written.");
  state().cancelled = true;
}

void watch(sigset_t signals) {
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    if (signal == crash_notice) {
      if (state().crash_signal != 0) end_after_crash();
      continue;
    }
    handle_interrupt();
  }
}

void on_crash(int signal) {
  int none = 0;
  if (state().crash_signal.compare_exchange_strong(none, signal)) {
    if (pthread_equal(pthread_self(), state().thread) == 0) {
      pthread_kill(state().thread, crash_notice);
      sleep(crash_patience);
    }
    write_text("meshcomplete: Something crashed. Nothing was written.\n");
    _exit(exit_failed);
  }
  // Another thread crashed first, and its message is on the way.
  for (;;) pause();
}

}  // namespace

void install() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, crash_notice);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before;
    // A signal that the caller ignores (nohup) stays ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaddset(&signals, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  std::thread watcher(watch, signals);
  state().thread = watcher.native_handle();
  watcher.detach();

  stack_t stack{};
  stack.ss_sp = state().alternate_stack;
  stack.ss_size = sizeof(state().alternate_stack);
  sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int signal : crash_signals) sigaction(signal, &action, nullptr);
}

void set_ending(Ending ending) {
  const std::lock_guard<std::mutex> lock(state().mutex);
  state().ending = std::move(ending);
}

void set_reaction(Reaction reaction) {
  const std::lock_guard<std::mutex> lock(state().mutex);
  state().reaction = reaction;
}

void set_activity(const QString& activity) {
  const std::lock_guard<std::mutex> lock(state().mutex);
  state().activity = activity.toStdString();
}

bool cancelled() { return state().cancelled; }

}  // namespace guard
}  // namespace runner
}  // namespace meshcomplete
