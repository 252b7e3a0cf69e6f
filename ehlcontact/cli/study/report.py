def write_report(found, path): return path
