"""Periodic answers of rotors: harmonic balance, shooting, stability.

| module | content |
|---|---|
| `answer` | one period of a rotor that repeats its motion |
"""
