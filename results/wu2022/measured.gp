# The actuator that was measured (figures 8, 10, 12, 14), by the model.
set datafile separator ','
set terminal pngcairo size 900,700 font 'sans,11'
set output 'results/wu2022/measured.png'
set multiplot layout 2,2
set grid lc '#dddddd'
set key top left
folder = 'results/wu2022/'
set xlabel 'voltage [kV] (8)'
set ylabel 'peak force [N]'
plot [][0:2] folder.'fig8.csv' using ($4/1000):($3>3e4 ? $6 : NaN) skip 1 with linespoints pt 7 ps 0.7 title 'model, 51.9 N/mm', \
     folder.'fig8.csv' using ($4/1000):($3<3e4 ? $6 : NaN) skip 1 with linespoints pt 7 ps 0.7 title 'model, 10.6 N/mm', \
     '-' using 1:2 with points pt 2 ps 1.4 lc 'black' title 'measured, both ends'
1.6,0.2
3.7,1.3
e
set xlabel 'layers n (10)'
plot [0.5:3.5][0:3] folder.'fig10.csv' using 1:6 skip 1 with linespoints pt 7 ps 0.7 notitle
set key center right
set xlabel 'gap [mm] (12)'
set ylabel 'amplitude [mm]'
set y2label 'frequency [Hz]'
set y2tics
set ytics nomirror
plot [0:1.8][0:2] folder.'fig12.csv' using ($2*1e3):($7*1e3) skip 1 with linespoints pt 7 ps 0.7 title 'amplitude', \
     folder.'fig12.csv' using ($2*1e3):8 skip 1 axes x1y2 with linespoints pt 6 ps 0.7 title 'frequency'
set xlabel 'stiffness [N/mm] (14)'
set ylabel 'peak force [N]'
set key top left
set y2range [40:80]
plot [0:210][0:4] folder.'fig14.csv' using ($3/1000):6 skip 1 with linespoints pt 7 ps 0.7 title 'peak force', \
     folder.'fig14.csv' using ($3/1000):8 skip 1 axes x1y2 with linespoints pt 6 ps 0.7 title 'frequency'
unset multiplot
