------- OpenFAST EXAMPLE INPUT FILE -------------------------------------------
A small turbine of our own, for the tests of the importer
---------------------- SIMULATION CONTROL --------------------------------------
False         Echo            - Echo input data to <RootName>.ech (flag)
"FATAL"       AbortLevel      - Error level when simulation should abort (string)
60            TMax            - Total run time (s)
---------------------- FEATURE SWITCHES AND FLAGS ------------------------------
1             CompElast       - Compute structural dynamics (switch) {1=ElastoDyn; 2=ElastoDyn + BeamDyn for blades}
1             CompInflow      - Compute inflow wind velocities (switch) {0=still air; 1=InflowWind}
2             CompAero        - Compute aerodynamic loads (switch) {0=None; 2=AeroDyn}
0             CompServo       - Compute control and electrical-drive dynamics (switch)
0             CompSub         - Compute sub-structural dynamics (switch)
---------------------- ENVIRONMENTAL CONDITIONS --------------------------------
9.81          Gravity         - Gravitational acceleration (m/s^2)
1.2           AirDens         - Air density (kg/m^3)
---------------------- INPUT FILES ---------------------------------------------
"ElastoDyn.dat"   EDFile       - Name of file containing ElastoDyn input parameters (quoted string)
"unused"   BDBldFile(1)    - Name of file containing BeamDyn input parameters for blade 1 (quoted string)
"unused"   BDBldFile(2)    - Name of file containing BeamDyn input parameters for blade 2 (quoted string)
"unused"   BDBldFile(3)    - Name of file containing BeamDyn input parameters for blade 3 (quoted string)
"Inflow.dat"  InflowFile     - Name of file containing inflow wind input parameters (quoted string)
"AeroDyn.dat" AeroFile       - Name of file containing aerodynamic input parameters (quoted string)
"unused"      ServoFile       - Name of file containing control input parameters (quoted string)
---------------------- OUTPUT --------------------------------------------------
   10, 20     LinTimes        - List of times at which to linearize (s)
True          TabDelim        - Use tab delimiters (flag)
