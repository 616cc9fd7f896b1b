/* Runs a command and lets one of its calls of the system fail, or kills the process that makes it.
 *
 *   fault N ENOSPC|EIO|KILL|NONE COMMAND…
 *
 * The calls are those that change files: they are counted from 1, in all processes of the command. Output that is not
 * in a file does not count. The last line on standard error is the number of calls. The exit code is that of the
 * command, or 128 and the number of the signal that ended it. Exit code 99: it does not work on this system.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

static const int CALLS[] = {
    SYS_write,     SYS_pwrite64,  SYS_writev,   SYS_openat,    SYS_fsync,     SYS_fdatasync, SYS_flock,
    SYS_fallocate, SYS_ftruncate, SYS_renameat, SYS_renameat2, SYS_linkat,    SYS_mkdirat,   SYS_unlinkat,
#ifdef SYS_open
    SYS_open,      SYS_rename,    SYS_link,     SYS_mkdir,     SYS_unlink,    SYS_rmdir,
#endif
};
enum { COUNT = sizeof CALLS / sizeof *CALLS };

static void die(const char *what) {
    perror(what);
    exit(99);
}

/* Sends or receives a descriptor. */
static int pass(int way, int given) {
    char byte = 0, room[CMSG_SPACE(sizeof(int))] = {0};
    struct iovec one = {&byte, 1};
    struct msghdr message = {.msg_iov = &one, .msg_iovlen = 1, .msg_control = room, .msg_controllen = sizeof room};
    struct cmsghdr *head = CMSG_FIRSTHDR(&message);
    if (given < 0) {
        if (recvmsg(way, &message, 0) <= 0 || !(head = CMSG_FIRSTHDR(&message))) return -1;
        memcpy(&given, CMSG_DATA(head), sizeof given);
        return given;
    }
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof(int));
    memcpy(CMSG_DATA(head), &given, sizeof given);
    return sendmsg(way, &message, 0) < 0 ? -1 : 0;
}

/* Starts the command, whose calls wait for an answer. */
static void start(int way, char **command) {
    struct sock_filter filter[COUNT + 3];
    filter[0] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int at = 0; at < COUNT; at++)
        filter[at + 1] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, CALLS[at], COUNT - at, 0);
    filter[COUNT + 1] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[COUNT + 2] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF);
    struct sock_fprog program = {COUNT + 3, filter};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) die("prctl");
    int calls = syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER, &program);
    if (calls < 0) die("seccomp");
    if (pass(way, calls)) die("sendmsg");
    close(calls);
    close(way);
    execvp(command[0], command);
    die(command[0]);
}

/* Whether a call changes a file. */
static int counts(const struct seccomp_notif *call) {
    const struct seccomp_data *data = &call->data;
    switch (data->nr) {
    case SYS_openat: return (data->args[2] & (O_ACCMODE | O_CREAT)) != O_RDONLY;
#ifdef SYS_open
    case SYS_open: return (data->args[1] & (O_ACCMODE | O_CREAT)) != O_RDONLY;
#endif
    case SYS_write: case SYS_writev: {
        char link[64];
        struct stat found;
        snprintf(link, sizeof link, "/proc/%d/fd/%d", (int)call->pid, (int)data->args[0]);
        return stat(link, &found) == 0 && S_ISREG(found.st_mode);
    }
    default: return 1;
    }
}

int main(int count, char **given) {
    if (count < 4) return 99;
    long number = atol(given[1]), seen = 0;
    int kill_it = !strcmp(given[2], "KILL");
    int error = kill_it ? 0 : !strcmp(given[2], "EIO") ? EIO : !strcmp(given[2], "ENOSPC") ? ENOSPC : 0;
    int ways[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ways)) die("socketpair");
    pid_t child = fork();
    if (child == 0) {
        close(ways[0]);
        start(ways[1], given + 3);
    }
    close(ways[1]);
    int calls = pass(ways[0], -1), status = 0;
    if (calls < 0) return 99;
#ifdef SECCOMP_IOCTL_NOTIF_SET_FLAGS
    /* Faster: the processes take turns on one core. */
    ioctl(calls, SECCOMP_IOCTL_NOTIF_SET_FLAGS, SECCOMP_USER_NOTIF_FD_SYNC_WAKE_UP);
#endif
    struct pollfd wait = {.fd = calls, .events = POLLIN};
    for (;;) {
        poll(&wait, 1, -1);
        if (!(wait.revents & POLLIN)) break; /* all processes have ended */
        struct seccomp_notif call;
        memset(&call, 0, sizeof call);
        if (ioctl(calls, SECCOMP_IOCTL_NOTIF_RECV, &call)) continue; /* its process has ended */
        struct seccomp_notif_resp answer = {.id = call.id, .flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE};
        if (counts(&call) && ++seen == number) {
            if (kill_it) kill(call.pid, SIGKILL);
            if (error) answer.flags = 0, answer.error = -error;
        }
        ioctl(calls, SECCOMP_IOCTL_NOTIF_SEND, &answer);
    }
    if (waitpid(child, &status, 0) < 0) die("waitpid");
    fprintf(stderr, "%ld\n", seen);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}
