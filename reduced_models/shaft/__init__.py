"""Rotors of a shaft, discs and supports, as matrices on ball bearings.

| module | is responsible for |
|---|---|
| parts | `Shaft`, `Disc`, `Support`: what a rotor is made of |
| beam | matrices of a piece of shaft |
| assembly | `rotor_on_bearings`: all of it as one `MatrixRotor` |
"""
