# Hysteresis: the branch solved for, the sweeps laid over it, every stable motion found.
set datafile separator ','
set terminal pngcairo size 900,1000 font 'sans,11'
set output 'results/wu2022/fig6.png'
set multiplot layout 3,1
set xrange [1.2:2.8]
set grid lc '#dddddd'
set key top left
set xlabel 'omega'
set ylabel 'amplitude'
folder = 'results/wu2022/'
branch = folder.'fig6-branch.csv'
sweep = folder.'fig6-sweep.csv'
free = folder.'fig6-sweep-no-stop.csv'
set title 'no stop (6a)'
plot free using 1:($2>0 ? $5 : NaN) skip 1 with lines lw 2 lc '#1f77b4' title 'forward sweep', \
     free using 1:($2<0 ? $5 : NaN) skip 1 with points pt 6 ps 0.5 lc '#d62728' title 'backward sweep'
set title 'stop at g = 0.1 (6b)'
plot branch using 3:4 skip 1 with lines dt 2 lc '#888888' title 'branch, unstable', \
     branch using 3:($8==1 ? $4 : NaN) skip 1 with lines lw 2 lc 'black' title 'branch, stable', \
     sweep using 1:($2>0 ? $5 : NaN) skip 1 with points pt 4 ps 0.5 lc '#1f77b4' title 'forward sweep', \
     sweep using 1:($2<0 ? $5 : NaN) skip 1 with points pt 6 ps 0.5 lc '#d62728' title 'backward sweep'
set title 'stop at g = 0.1: every stable motion found'
set ylabel 'peak force'
subharmonic = folder.'fig6-subharmonics.csv'
found = folder.'fig6-attractors.csv'
plot branch using 3:5 skip 1 with lines dt 2 lc '#888888' title 'period 1, unstable', \
     branch using 3:($8==1 ? $5 : NaN) skip 1 with lines lw 2 lc 'black' title 'period 1, stable', \
     for [b=1:5] subharmonic using 3:($1==b && $8==1 ? $5 : NaN) skip 1 with lines lw 2 lc '#ff7f0e' \
         title (b==1 ? 'periods 2, 3, 4, stable' : ''), \
     folder.'fig6-boundaries.csv' using 3:6 skip 1 with points pt 9 ps 1 lc 'black' title 'fold, flip, grazing', \
     found using 1:(strcol(2) eq 'periodic' ? $6 : NaN) skip 1 with points pt 6 ps 0.6 lc '#2ca02c' title 'attractor, periodic', \
     found using 1:(strcol(2) eq 'chaotic' ? $6 : NaN) skip 1 with points pt 2 ps 0.6 lc '#9467bd' title 'attractor, chaotic'
unset multiplot
