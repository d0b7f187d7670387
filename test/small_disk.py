"""A disk of a few megabytes that one program alone sees, for what happens when it is full."""
import os
import subprocess

SPACES = ["--mount"] if os.geteuid() == 0 else ["--mount", "--map-root-user"]


def is_permitted():
    """Whether this machine lets programs mount disks of their own."""
    tried = ["unshare", *SPACES, "mount", "-t", "tmpfs", "none", "/mnt"]
    return subprocess.run(tried, stderr=subprocess.DEVNULL).returncode == 0


class SmallDisk:
    """Mounted at `path`, a folder, by the program that is started with `prefix`."""

    def __init__(self, path, megabytes):
        os.mkdir(path)
        self.path = path
        script = 'mount -t tmpfs -o size="$1" none "$2" && shift 2 && exec "$@"'
        self.prefix = ["unshare", *SPACES, "sh", "-c", script, "sh", f"{megabytes}m", path]
        self._pid = None

    def enter(self, pid):
        """Of the program."""
        self._pid = pid

    def inside(self, path):
        """Where all others find what the program finds at `path`."""
        return f"/proc/{self._pid}/root{path}"

    def fill(self, but_bytes):
        """Until no more than that is free."""
        with open(self._filler(), "wb", buffering=0) as filler:
            try:
                while True:
                    filler.write(bytes(1 << 16))
            except OSError:
                filler.truncate(filler.tell() - but_bytes)

    def empty(self):
        os.remove(self._filler())

    def remount(self, option):
        """`ro` or `rw`."""
        enter = ["nsenter", "--target", str(self._pid), "--mount"]
        if os.geteuid() != 0:
            enter += ["--user", "--preserve-credentials"]
        subprocess.run([*enter, "mount", "-o", "remount," + option, self.path], check=True)

    def _filler(self):
        return self.inside(os.path.join(self.path, "filler"))
