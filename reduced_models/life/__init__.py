"""Rating life of ball bearings by the standards, from the loads of all balls.

| module | is responsible for |
|---|---|
| internal_geometry | `InternalGeometry`: what the standards need of a bearing |
| load_ratings | `LoadRatings`: C, C0 and Cu from the geometry, from a catalogue, or as they are given |
| equivalent_load | equivalent dynamic and static loads with X and Y; least load against skidding |
| life_modification | viscosity ratio, contamination, the factors a_ISO and a1 |
| bearing_life | `BearingLife`: basic and modified reference rating life of one bearing |
| history | `BearingHistory`: loads of all balls over a run |
| system_life | `SystemLife` of several bearings; `SpectrumLife` over a load spectrum |

Sources: ISO 281:2007 (ratings, X and Y, a_ISO, contamination), ISO/TR 1281-1 and -2 (their derivation, a1), ISO 76
(static rating), ISO/TS 16281 (life from the loads of all balls), SKF, Rolling Bearings (least load).
"""
