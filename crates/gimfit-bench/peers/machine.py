"""What a reader must know of the machine; nothing that names it."""
import datetime
import os
import platform
import subprocess


def first_line(file, key):
    try:
        with open(file) as lines:
            return next((line.split(":", 1)[1].strip() for line in lines if line.startswith(key)), "")
    except OSError:
        return ""


def huge_pages():
    try:
        with open("/sys/kernel/mm/transparent_hugepage/enabled") as file:
            text = file.read()
        return text[text.index("[") + 1:text.index("]")]
    except (OSError, ValueError):
        return "unknown"


def describe():
    """(what, value) pairs."""
    import numpy
    import scipy
    memory = first_line("/proc/meminfo", "MemTotal").removesuffix(" kB")
    virtual = " hypervisor" in " " + first_line("/proc/cpuinfo", "flags")
    rustc = subprocess.run(["rustc", "--version"], capture_output=True, text=True).stdout.split()
    return [
        ("date", datetime.date.today().isoformat()),
        ("processor", first_line("/proc/cpuinfo", "model name") or platform.machine()),
        ("cores", f"{os.cpu_count()}{', virtual machine' if virtual else ''}; one thread used"),
        ("memory", f"{int(memory) / 2**20:.0f} GiB" if memory else "unknown"),
        ("system", f"{platform.system()} {platform.release().split('-')[0]}, huge pages: {huge_pages()}"),
        ("Rust", rustc[1] if len(rustc) > 1 else "unknown"),
        ("Python", f"{platform.python_version()}, NumPy {numpy.__version__}, SciPy {scipy.__version__}"),
    ]
